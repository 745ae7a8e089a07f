#include "service/service_notification.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "unit/service/service_manager.h"

namespace edgeslam {
namespace {

class ServiceNotifications : public testing::Test {
 protected:
  std::vector<std::string> toldBy(ServiceNotification& service) const {
    EXPECT_TRUE(service.waitUntilTold());
    return manager_.told();
  }

 private:
  ServiceManager manager_;
};

using Told = std::vector<std::string>;
constexpr auto millisecond = std::chrono::milliseconds(1);

TEST_F(ServiceNotifications, StartAndEnd) {
  ServiceNotification service;
  EXPECT_EQ(toldBy(service), Told{});
  service.ready();
  service.stopping();
  EXPECT_EQ(toldBy(service), (Told{"READY=1", "STOPPING=1\nWATCHDOG_USEC=3600000000"}))
      << "a map that takes long to write is not cut short";
}

TEST_F(ServiceNotifications, AStatusIsOneLineAndToldOnce) {
  ServiceNotification service;
  service.status("tracking");
  service.status("tracking");
  service.status("lost\nWATCHDOG=1");
  EXPECT_EQ(toldBy(service), (Told{"STATUS=tracking", "STATUS=lost WATCHDOG=1"}));
}

TEST_F(ServiceNotifications, TheWatchdogIsFedFourTimesInItsTime) {
  ServiceNotification service;
  const ServiceNotification::Clock::time_point start(std::chrono::hours(1));
  for (int i = 0; i < 2000; ++i) service.alive(start + i * millisecond);
  EXPECT_EQ(toldBy(service), Told(4, "WATCHDOG=1"));
  EXPECT_EQ(toldBy(service), Told{}) << "no frames, no food";
}

TEST_F(ServiceNotifications, WithoutAWatchdogNothingIsFed) {
  unsetenv("WATCHDOG_USEC");
  ServiceNotification service;
  for (int i = 0; i < 5; ++i) service.alive(ServiceNotification::Clock::time_point(std::chrono::hours(i)));
  EXPECT_EQ(toldBy(service), Told{});
  service.stopping();
  EXPECT_EQ(toldBy(service), Told{"STOPPING=1"});
}

TEST_F(ServiceNotifications, AnotherProcessesWatchdogIsNotOurs) {
  setenv("WATCHDOG_PID", "1", 1);
  ServiceNotification service;
  service.alive(ServiceNotification::Clock::time_point(std::chrono::hours(1)));
  EXPECT_EQ(toldBy(service), Told{});
  unsetenv("WATCHDOG_PID");
}

TEST_F(ServiceNotifications, OutsideAServiceNothingHappens) {
  unsetenv("NOTIFY_SOCKET");
  ServiceNotification service;
  service.ready();
  service.status("tracking");
  service.alive(ServiceNotification::Clock::time_point(std::chrono::hours(1)));
  EXPECT_EQ(toldBy(service), Told{});
}

}  // namespace
}  // namespace edgeslam
