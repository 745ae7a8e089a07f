// What Cyclone DDS complains of, kept for the log in place of its own lines on the standard error.
#pragma once

#include <dds/ddsrt/log.h>

#include <mutex>
#include <string>

namespace edgeslam {

// At most one at a time in a program: Cyclone DDS has one log.
class DdsLog {
 public:
  DdsLog();
  ~DdsLog();
  DdsLog(const DdsLog&) = delete;
  DdsLog& operator=(const DdsLog&) = delete;

  // The latest since the call before, or empty.
  std::string take();

 private:
  static void write(void* log, const dds_log_data_t* data);

  std::mutex mutex_;
  std::string latest_;
};

}  // namespace edgeslam
