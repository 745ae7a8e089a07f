#include "drivers/ros2/dds/dds_log.h"

#include <utility>

namespace edgeslam {

DdsLog::DdsLog() { dds_set_log_sink(&DdsLog::write, this); }

DdsLog::~DdsLog() { dds_set_log_sink(nullptr, nullptr); }

std::string DdsLog::take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(latest_, "");
}

void DdsLog::write(void* log, const dds_log_data_t* data) {
  auto& self = *static_cast<DdsLog*>(log);
  const std::lock_guard<std::mutex> lock(self.mutex_);
  self.latest_.assign(data->message, data->size);
  self.latest_.erase(self.latest_.find_last_not_of("\n ") + 1);
}

}  // namespace edgeslam
