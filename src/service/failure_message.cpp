#include "service/failure_message.h"

#include <unistd.h>

#include <new>
#include <opencv2/core.hpp>
#include <string_view>
#include <system_error>

#include "edgeslam/input_error.h"
#include "service/exit_code.h"

namespace edgeslam {
namespace {

void say(std::string_view text) {
  if (::write(STDERR_FILENO, text.data(), text.size()) < 0) return;  // nobody listens
}

// Without memory of its own, as there may be none.
[[noreturn]] void endWithMessage() noexcept {
  say("edgeslam: ");
  try {
    if (std::current_exception()) throw;
    say("internal error");
  } catch (const std::bad_alloc&) {
    say("out of memory");
  } catch (const std::exception& error) {
    say(failureMessage(error));
  } catch (...) {
    say("internal error");
  }
  say("\n");
  ::_exit(exit_failed);
}

}  // namespace

std::string failureMessage(const std::exception& error) {
  if (dynamic_cast<const InputError*>(&error)) return error.what();
  if (dynamic_cast<const std::bad_alloc*>(&error)) return "out of memory";
  const auto* image_error = dynamic_cast<const cv::Exception*>(&error);
  if (image_error && image_error->code == cv::Error::StsNoMem) return "out of memory";
  const auto* system_error = dynamic_cast<const std::system_error*>(&error);
  if (system_error && system_error->code() == std::errc::resource_unavailable_try_again) {
    return "no thread can be started: out of memory, or over the limit of processes";
  }
  return std::string("internal error: ") + error.what();
}

void tellUncaughtErrors() { std::set_terminate(endWithMessage); }

}  // namespace edgeslam
