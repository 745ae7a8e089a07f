#include "benchmark/sequence_search.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "files/format_text.h"
#include "frames/frame_source.h"
#include "recording/open_frame_source.h"
#include "recording/recording_source.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

bool hasCalibration(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / "camera.yaml", error) || fs::is_regular_file(folder / "camera_info.yaml", error);
}

// A video or images alone may be anything: an illustration, the frames of the sequence above.
bool isSequence(const fs::path& folder) {
  if (isRecording(folder.string())) return true;
  switch (folderKind(folder.string())) {
    case FolderKind::none:
      return false;
    case FolderKind::video:
    case FolderKind::images:
      return hasCalibration(folder);
    default:
      return true;
  }
}

std::vector<fs::path> foldersIn(const fs::path& folder) {
  std::vector<fs::path> folders;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    std::error_code error;
    const bool is_hidden = entry.path().filename().string().front() == '.';
    if (!is_hidden && entry.is_directory(error)) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

class Search {
 public:
  Search(const fs::path& left_out, const SearchLimits& limits) : left_out_(left_out), limits_(limits) {}

  void lookInto(const fs::path& folder, int depth) {
    std::error_code error;
    const fs::path real = fs::canonical(folder, error);
    if (error || real == left_out_ || !seen_.insert(real.string()).second) return;
    if (static_cast<int>(seen_.size()) > limits_.folders) {
      throw InputError("more than " + std::to_string(limits_.folders) +
                       " folders to look into; give a folder nearer to the sequences");
    }
    try {
      if (isSequence(real)) {
        sequences_.push_back(real);
        return;
      }
      const std::vector<fs::path> below = foldersIn(real);
      if (depth == limits_.depth && !below.empty()) {
        notes_.push_back(real.string() + ": deeper folders are not looked into");
        return;
      }
      for (const fs::path& next : below) lookInto(next, depth + 1);
    } catch (const fs::filesystem_error& problem) {
      notes_.push_back(real.string() + ": cannot be listed: " + problem.code().message());
    }
  }

  const std::vector<fs::path>& sequences() const { return sequences_; }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  fs::path left_out_;
  SearchLimits limits_;
  std::set<std::string> seen_;
  std::vector<fs::path> sequences_;
  std::vector<std::string> notes_;
};

// The last `parts` parts of the path.
std::string tailOf(const fs::path& folder, int parts) {
  std::vector<std::string> all;
  for (const fs::path& part : folder) {
    if (part != folder.root_path()) all.push_back(part.string());
  }
  const std::size_t first = all.size() - std::min(all.size(), static_cast<std::size_t>(parts));
  std::string name;
  for (std::size_t i = first; i < all.size(); ++i) name += (i > first ? "_" : "") + all[i];
  return name.empty() ? "sequence" : name;
}

// As many parts of its path as set it apart from the others.
std::vector<std::string> namesOf(const std::vector<fs::path>& folders) {
  constexpr int most_parts = 8;
  std::vector<std::string> names;
  for (const fs::path& folder : folders) {
    int parts = 1;
    const auto sameTail = [&](const fs::path& other) { return tailOf(other, parts) == tailOf(folder, parts); };
    while (parts < most_parts && std::count_if(folders.begin(), folders.end(), sameTail) > 1) ++parts;
    std::string name = tailOf(folder, parts);
    const std::string base = name;
    for (int i = 2; std::find(names.begin(), names.end(), name) != names.end(); ++i)
      name = base + "_" + std::to_string(i);
    names.push_back(name);
  }
  return names;
}

FoundSequence opened(const fs::path& folder, const std::string& name) {
  FoundSequence found;
  found.name = name;
  found.folder = folder.string();
  try {
    const auto source = openFrameSource(found.folder);
    found.kind = source->kind();
    found.frames = source->size();
    found.has_calibration = source->camera().has_value();
  } catch (const std::exception& problem) {  // cv::Exception among them
    found.problem = problem.what();
  }
  return found;
}

}  // namespace

SequenceSearch findSequences(const std::string& folder, const std::string& left_out, const SearchLimits& limits) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) throw InputError(folder + ": is no folder to look for sequences in");
  Search search(fs::weakly_canonical(left_out, error), limits);
  search.lookInto(folder, 0);
  SequenceSearch result;
  result.notes = search.notes();
  const std::vector<std::string> names = namesOf(search.sequences());
  for (std::size_t i = 0; i < names.size(); ++i) result.sequences.push_back(opened(search.sequences()[i], names[i]));
  std::sort(result.sequences.begin(), result.sequences.end(),
            [](const FoundSequence& a, const FoundSequence& b) { return a.name < b.name; });
  return result;
}

std::string sequenceFingerprint(const std::string& folder) {
  constexpr int deepest = 4;
  constexpr std::uint64_t prime = 0x100000001b3, offset = 0xcbf29ce484222325;  // FNV-1a, 64 bits
  std::map<std::string, std::string> files;
  std::error_code error;
  fs::recursive_directory_iterator entries(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entries != fs::recursive_directory_iterator(); entries.increment(error)) {
    if (entries.depth() >= deepest) entries.disable_recursion_pending();
    struct stat status {};
    if (stat(entries->path().c_str(), &status) != 0 || !S_ISREG(status.st_mode)) continue;
    files[entries->path().string()] = std::to_string(status.st_size) + " " + std::to_string(status.st_mtim.tv_sec) +
                                      " " + std::to_string(status.st_mtim.tv_nsec);
  }
  std::uint64_t hash = offset;
  for (const auto& [path, state] : files) {
    for (const char c : path + '\0' + state + '\0') hash = (hash ^ static_cast<unsigned char>(c)) * prime;
  }
  return formatted("%016llx", static_cast<unsigned long long>(hash));
}

}  // namespace edgeslam
