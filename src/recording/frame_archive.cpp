#include "recording/frame_archive.h"

#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "files/format_text.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

// A field of a header: where it begins, and its length [bytes].
struct Field {
  std::size_t begin, length;
};

constexpr Field name_field{0, 100}, mode_field{100, 8}, owner_field{108, 8}, group_field{116, 8}, size_field{124, 12},
    time_field{136, 12}, checksum_field{148, 8}, type_field{156, 1}, magic_field{257, 8};

void put(std::array<char, archive_block>& header, Field field, std::string_view text) {
  std::copy_n(text.begin(), std::min(text.size(), field.length), header.begin() + static_cast<int>(field.begin));
}

// Octal digits that fill the field but for the zero at its end.
void put(std::array<char, archive_block>& header, Field field, std::uint64_t value) {
  put(header, field, formatted("%0*lo", static_cast<int>(field.length) - 1, static_cast<unsigned long>(value)));
}

}  // namespace

std::array<char, archive_block> archiveHeader(const std::string& name, std::int64_t time_ns, std::size_t size) {
  std::array<char, archive_block> header{};
  put(header, name_field, name);
  put(header, mode_field, 0644);
  put(header, owner_field, 0);
  put(header, group_field, 0);
  put(header, size_field, size);
  put(header, time_field, static_cast<std::uint64_t>(time_ns / 1'000'000'000));
  put(header, type_field, "0");
  put(header, magic_field, std::string_view("ustar\00000", 8));
  put(header, checksum_field, "        ");  // is summed up as blanks
  const auto sum = std::accumulate(header.begin(), header.end(), 0UL,
                                   [](unsigned long total, char c) { return total + static_cast<unsigned char>(c); });
  put(header, checksum_field, formatted("%06lo", sum) + '\0');
  return header;
}

std::size_t archivePadding(std::size_t size) { return (archive_block - size % archive_block) % archive_block; }

std::uint32_t imageChecksum(std::string_view image) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(image.data()), image.size()));
}

ArchivedBytes readArchivedImage(const std::string& path, const ArchivedImage& image) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return {"", path + ": no such file"};
  const std::uintmax_t archive_size = fs::file_size(path, error);
  const auto offset = static_cast<std::uintmax_t>(image.offset), size = static_cast<std::uintmax_t>(image.size);
  const std::string place = placeInArchive(path, image);
  if (error || offset > archive_size || size > archive_size - offset) return {"", place + "the frame is cut off"};
  std::ifstream file(path, std::ios::binary);
  std::string bytes(size, '\0');
  file.seekg(image.offset).read(bytes.data(), image.size);
  if (!file) return {"", place + "the frame cannot be read"};
  if (imageChecksum(bytes) != image.checksum) return {"", place + "the frame is damaged: its checksum is another one"};
  return {std::move(bytes), ""};
}

std::string placeInArchive(const std::string& path, const ArchivedImage& image) {
  return path + ": at byte " + std::to_string(image.offset) + ": ";
}

}  // namespace edgeslam
