// A network that a test has for itself: no message from or to anyone else.
#pragma once

#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

namespace edgeslam {

inline bool runsWell(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

inline bool switchNetworkOn() { return runsWell("ip link set lo up && ip route replace 224.0.0.0/4 dev lo"); }
inline bool switchNetworkOff() { return runsWell("ip link set lo down"); }

// Once in a process, before it has threads. Empty, or why it is not allowed.
inline std::string enterOwnNetwork() {
  const uid_t user = geteuid();
  if (unshare(CLONE_NEWNET) != 0) {
    if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) {
      return std::string("no network namespace is allowed here (") + std::strerror(errno) + ")";
    }
    std::ofstream("/proc/self/uid_map") << "0 " << user << " 1\n";
  }
  if (!switchNetworkOn()) return "`ip` cannot set up the loopback interface";
  return "";
}

class OwnNetwork : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    unsetenv("LCM_DEFAULT_URL");
    if (problem_ == "not entered") problem_ = enterOwnNetwork();
  }
  void SetUp() override {
    if (!problem_.empty()) GTEST_SKIP() << problem_;
    ASSERT_TRUE(switchNetworkOn());
  }

 private:
  inline static std::string problem_ = "not entered";
};

}  // namespace edgeslam
