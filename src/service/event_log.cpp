#include "service/event_log.h"

#include <algorithm>

namespace edgeslam {

void EventLog::tell(const std::string& line, Clock::time_point now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::string text;
  if (window_start_ == Clock::time_point() || now - window_start_ >= std::chrono::seconds(window_s)) {
    if (left_out_ > 0) text = "edgeslam: " + std::to_string(left_out_) + " lines were left out\n";
    window_start_ = now;
    lines_ = left_out_ = 0;
  }
  if (lines_ == most_lines) {
    ++left_out_;
    return;
  }
  ++lines_;
  std::string one_line = line;
  std::replace_if(
      one_line.begin(), one_line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  text += "edgeslam: " + one_line + '\n';
  if (!outside_.hand([&stream = stream_, text] { stream << text << std::flush; })) ++left_out_;
}

}  // namespace edgeslam
