// The files of a recording while it is being written, in an order in which a power cut can come at any moment: a list
// names only what the disk has confirmed.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace edgeslam {

// A file or folder that is closed at the end.
class OpenFile {
 public:
  OpenFile() = default;
  explicit OpenFile(int descriptor) : descriptor_(descriptor) {}
  ~OpenFile();
  OpenFile(OpenFile&& other) noexcept;
  OpenFile& operator=(OpenFile&& other) noexcept;
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_ = -1;  // -1: none
};

// Every function but the constructor answers with what went wrong, path and reason, or an empty text.
class RecordingFiles {
 public:
  // Makes the folder with the files that every recording has, confirmed by the disk; recording.txt comes last. `mask`:
  // the content of mask.png; empty: there is none. Throws InputError where the folder is there and not empty or where
  // that fails, and then leaves nothing behind.
  RecordingFiles(const std::string& folder, const std::string& camera, const std::string& configuration,
                 const std::string& description, const std::string& mask = "");

  // Appends a frame's image file to rgb.tar, where it gets that name; the disk begins to take it. Where that fails,
  // nothing of it is left.
  std::string addFrame(const std::string& name, std::int64_t time_ns, const std::vector<unsigned char>& image);
  // Of the next image in rgb.tar [byte].
  std::int64_t nextOffset() const;
  // Waits until the disk holds all frames added.
  std::string confirmFrames();
  // Appends whole lines and waits until the disk holds them. Where that fails, those lines stay that fitted.
  std::string appendDecisions(std::string_view lines);
  std::string appendList(std::string_view lines);

  // [bytes] that the disk has left for us; 0 where it does not say.
  std::int64_t freeBytes() const;

 private:
  struct GrowingFile {
    OpenFile file;
    std::string path;
    off_t length = 0;  // [bytes], whole lines or frames
  };
  static GrowingFile openToAppend(const std::string& folder, const char* name);
  static std::string appendLines(GrowingFile& file, std::string_view lines);

  GrowingFile frames_, decisions_, list_;
  off_t confirmed_frames_ = 0;  // [bytes]
};

}  // namespace edgeslam
