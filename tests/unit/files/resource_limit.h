// A limit of this process while it lives: files that cannot grow (what a full disk does to a write) or be opened.
#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <csignal>

namespace edgeslam {

class ResourceLimit {
 public:
  ResourceLimit(decltype(RLIMIT_FSIZE) resource, rlim_t value)
      : resource_(resource), handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(resource_, &before_);
    const rlimit limit{std::min(value, before_.rlim_max), before_.rlim_max};
    setrlimit(resource_, &limit);
  }
  ~ResourceLimit() {
    setrlimit(resource_, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  ResourceLimit(const ResourceLimit&) = delete;
  ResourceLimit& operator=(const ResourceLimit&) = delete;

 private:
  decltype(RLIMIT_FSIZE) resource_;
  rlimit before_{};
  void (*handler_)(int);
};

}  // namespace edgeslam
