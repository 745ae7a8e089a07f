// The archive of a recording's frames, rgb.tar: image files one behind the other, each after a header of POSIX's tar
// (ustar) and filled up to whole blocks, so that any tar unpacks them. It grows by appending, and ends where the file
// does. What reads it here goes by the lines of decisions.txt, which say where an image lies.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace edgeslam {

constexpr const char* frame_archive_name = "rgb.tar";
constexpr std::size_t archive_block = 512;  // [bytes]

struct ArchivedImage {
  std::int64_t offset = 0;     // of the image file's first byte, in the archive
  std::int64_t size = 0;       // [bytes]
  std::uint32_t checksum = 0;  // CRC-32 (zlib's crc32) of these bytes
};

// What stands before an image file of so many bytes. `name`: under 100 bytes; `time_ns`: since 1970.
std::array<char, archive_block> archiveHeader(const std::string& name, std::int64_t time_ns, std::size_t size);

// [bytes] that fill up the last block of an image file.
std::size_t archivePadding(std::size_t size);

std::uint32_t imageChecksum(std::string_view image);

struct ArchivedBytes {
  std::string bytes;    // of the image file
  std::string problem;  // with the path and the place, why they could not be read; otherwise empty
};

// Takes no memory before the archive is known to have so many bytes.
ArchivedBytes readArchivedImage(const std::string& path, const ArchivedImage& image);

// "PATH: at byte N: ", how messages about an image in the archive begin.
std::string placeInArchive(const std::string& path, const ArchivedImage& image);

}  // namespace edgeslam
