#include "frames/folder_source.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <utility>

#include "files/text_file.h"
#include "frames/image_file.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

void checkIncreasing(const std::string& list_path, const TextLine& line, const std::vector<StampedFile>& files,
                     std::int64_t time_ns) {
  if (files.empty() || time_ns > files.back().time_ns) return;
  throw InputError(placeInFile(list_path, line.number) + "the time stamp " + formatStamp(time_ns) + " s " +
                   (time_ns == files.back().time_ns ? "is the same as" : "lies before") +
                   " that of the frame before (" + formatStamp(files.back().time_ns) +
                   " s); time stamps must increase");
}

// The path of a file that a list names. Control characters are in no name that a data set has, only in a damaged list.
std::string pathInFolder(const fs::path& folder, std::string_view name, const std::string& place) {
  const auto isControl = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  if (std::any_of(name.begin(), name.end(), isControl)) {
    throw InputError(place + "the file's name '" + std::string(name) + "' has control characters");
  }
  return (folder / std::string(name)).string();
}

// Column of the colour image's name: in associations.txt it may come second or fourth.
std::size_t colourColumn(const std::vector<std::string_view>& columns) {
  if (columns.size() >= 4 && columns[1].find("depth") != std::string_view::npos) return 3;
  return 1;
}

// A line of rgb.txt or associations.txt.
StampedFile readImageLine(const std::string& list_path, const TextLine& line, const std::vector<StampedFile>& before) {
  const std::string place = placeInFile(list_path, line.number);
  const std::vector<std::string_view> columns = splitColumns(line.text);
  if (columns.size() < 2) throw InputError(place + "expected 'time-stamp file', found '" + line.text + "'");
  const std::size_t column = colourColumn(columns);
  const std::optional<std::int64_t> time = parseStamp(columns[column - 1]);
  if (!time) throw InputError(place + "'" + std::string(columns[column - 1]) + "' is not a time stamp [s]");
  checkIncreasing(list_path, line, before, *time);
  return {*time, pathInFolder(fs::path(list_path).parent_path(), columns[column], place)};
}

class FolderSource : public FrameSource {
 public:
  FolderSource(std::string kind, std::vector<StampedFile> files, FrameCompanions companions)
      : kind_(std::move(kind)), files_(std::move(files)), companions_(std::move(companions)) {
    if (companions_.camera) {
      expected_ = {{companions_.camera->width, companions_.camera->height}, companions_.camera_path + " says"};
    }
  }

  std::optional<Frame> next() override {
    if (next_ >= files_.size()) return std::nullopt;
    const StampedFile& file = files_[next_];
    Frame frame;
    frame.index = static_cast<std::int64_t>(next_++);
    frame.time_ns = file.time_ns;
    DecodedImage image = readGreyImage(file.path, expected_);
    if (!image.problem.empty()) {
      frame.problem = image.problem;
      return frame;
    }
    if (expected_.size.empty()) expected_ = {image.grey.size(), "those before are"};
    frame.grey = std::move(image.grey);
    return frame;
  }

  std::int64_t size() const override { return static_cast<std::int64_t>(files_.size()); }
  std::string kind() const override { return kind_; }
  std::optional<Camera> camera() const override { return companions_.camera; }
  std::string groundTruthPath() const override { return companions_.ground_truth_path; }
  InertialFiles inertialFiles() const override { return companions_.inertial_files; }
  std::string wheelOdometryPath() const override { return companions_.wheel_odometry_path; }

 private:
  std::string kind_;
  std::vector<StampedFile> files_;
  FrameCompanions companions_;
  std::size_t next_ = 0;
  ExpectedSize expected_;
};

}  // namespace

std::vector<StampedFile> readTumImageList(const std::string& list_path) {
  std::vector<StampedFile> files;
  for (const TextLine& line : readTextLines(list_path)) {
    try {
      files.push_back(readImageLine(list_path, line, files));
    } catch (const InputError&) {
      if (line.ended || files.empty()) throw;
    }
  }
  if (files.empty()) throw InputError(list_path + ": lists no frames; expected lines 'time-stamp file'");
  return files;
}

std::vector<StampedFile> readEurocImageList(const std::string& csv_path) {
  const fs::path folder = fs::path(csv_path).parent_path() / "data";
  std::vector<StampedFile> files;
  for (const TextLine& line : readTextLines(csv_path)) {
    const std::vector<std::string_view> columns = splitColumns(line.text);
    const std::optional<std::int64_t> time = columns.empty() ? std::nullopt : parseNanoseconds(columns[0]);
    if (columns.size() != 2 || !time) {
      throw InputError(placeInFile(csv_path, line.number) + "expected 'time-stamp [ns],file', found '" + line.text +
                       "'");
    }
    checkIncreasing(csv_path, line, files, *time);
    files.push_back({*time, pathInFolder(folder, columns[1], placeInFile(csv_path, line.number))});
  }
  if (files.empty()) throw InputError(csv_path + ": lists no frames; expected lines 'time-stamp [ns],file'");
  return files;
}

std::vector<StampedFile> imagesNamedByTime(const std::string& folder) {
  std::vector<StampedFile> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (!isImageFileName(entry.path().filename().string())) continue;
    const std::string stem = entry.path().stem().string();
    const std::optional<std::int64_t> time = parseStamp(stem);
    const bool has_point = stem.find('.') != std::string::npos;
    if (!time || (!has_point && *time != parseNanoseconds(stem))) {
      throw InputError(entry.path().string() +
                       ": the name is not a time stamp; expected seconds with a decimal point (1305031102.175304.png) "
                       "or whole nanoseconds (1403636579763555584.png), or an rgb.txt that lists 'time-stamp file'");
    }
    files.push_back({*time, entry.path().string()});
  }
  std::sort(files.begin(), files.end(), [](const StampedFile& a, const StampedFile& b) {
    return std::tie(a.time_ns, a.path) < std::tie(b.time_ns, b.path);
  });
  const auto repeated = std::adjacent_find(
      files.begin(), files.end(), [](const StampedFile& a, const StampedFile& b) { return a.time_ns == b.time_ns; });
  if (repeated != files.end()) {
    throw InputError(std::next(repeated)->path + ": has the same time stamp as " + repeated->path);
  }
  return files;
}

bool isImageFileName(const std::string& name) {
  constexpr std::array<const char*, 9> extensions{".png", ".jpg", ".jpeg", ".bmp", ".pgm",
                                                  ".ppm", ".tif", ".tiff", ".webp"};
  std::string extension = fs::path(name).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return name.front() != '.' && std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

std::unique_ptr<FrameSource> makeFolderSource(std::string kind, std::vector<StampedFile> files,
                                              FrameCompanions companions) {
  return std::make_unique<FolderSource>(std::move(kind), std::move(files), std::move(companions));
}

}  // namespace edgeslam
