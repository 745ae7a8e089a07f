#include "app/service_notification.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "unit/dataset/temporary_folder.h"

namespace edgeslam {
namespace {

// Stands in for the service manager.
class ServiceNotifications : public testing::Test {
 protected:
  ServiceNotifications() : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string path = folder_.path("notify");
    path.copy(address.sun_path, sizeof(address.sun_path) - 1);
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    setenv("NOTIFY_SOCKET", path.c_str(), 1);
    setenv("WATCHDOG_USEC", "2000000", 1);
    unsetenv("WATCHDOG_PID");
  }
  ~ServiceNotifications() override {
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");
    close(socket_);
  }

  std::vector<std::string> told() const {
    std::vector<std::string> messages;
    std::array<char, 4096> buffer{};
    for (ssize_t bytes = 0; (bytes = recv(socket_, buffer.data(), buffer.size(), 0)) >= 0;) {
      messages.emplace_back(buffer.data(), static_cast<std::size_t>(bytes));
    }
    return messages;
  }

 private:
  TemporaryFolder folder_;
  int socket_;
};

using Told = std::vector<std::string>;
constexpr auto kMillisecond = std::chrono::milliseconds(1);

TEST_F(ServiceNotifications, StartAndEnd) {
  ServiceNotification service;
  EXPECT_EQ(told(), Told{});
  service.ready();
  service.stopping();
  EXPECT_EQ(told(), (Told{"READY=1", "STOPPING=1"}));
}

TEST_F(ServiceNotifications, AStatusIsOneLineAndToldOnce) {
  ServiceNotification service;
  service.status("tracking");
  service.status("tracking");
  service.status("lost\nWATCHDOG=1");
  EXPECT_EQ(told(), (Told{"STATUS=tracking", "STATUS=lost WATCHDOG=1"}));
}

TEST_F(ServiceNotifications, TheWatchdogIsFedFourTimesInItsTime) {
  ServiceNotification service;
  const ServiceNotification::Clock::time_point start(std::chrono::hours(1));
  for (int i = 0; i < 2000; ++i) service.alive(start + i * kMillisecond);
  EXPECT_EQ(told(), Told(4, "WATCHDOG=1"));
  EXPECT_EQ(told(), Told{}) << "no frames, no food";
}

TEST_F(ServiceNotifications, WithoutAWatchdogNothingIsFed) {
  unsetenv("WATCHDOG_USEC");
  ServiceNotification service;
  for (int i = 0; i < 5; ++i) service.alive(ServiceNotification::Clock::time_point(std::chrono::hours(i)));
  EXPECT_EQ(told(), Told{});
}

TEST_F(ServiceNotifications, AnotherProcessesWatchdogIsNotOurs) {
  setenv("WATCHDOG_PID", "1", 1);
  ServiceNotification service;
  service.alive(ServiceNotification::Clock::time_point(std::chrono::hours(1)));
  EXPECT_EQ(told(), Told{});
  unsetenv("WATCHDOG_PID");
}

TEST_F(ServiceNotifications, OutsideAServiceNothingHappens) {
  unsetenv("NOTIFY_SOCKET");
  ServiceNotification service;
  service.ready();
  service.status("tracking");
  service.alive(ServiceNotification::Clock::time_point(std::chrono::hours(1)));
  EXPECT_EQ(told(), Told{});
}

}  // namespace
}  // namespace edgeslam
