#include "service/failure_message.h"

#include <gtest/gtest.h>

#include <new>
#include <opencv2/core.hpp>
#include <system_error>
#include <thread>

#include "edgeslam/input_error.h"

namespace edgeslam {
namespace {

TEST(FailureMessage, SaysInWordsWhatTheSystemLacks) {
  EXPECT_EQ(failureMessage(std::bad_alloc()), "out of memory");
  EXPECT_EQ(failureMessage(cv::Exception(cv::Error::StsNoMem, "Failed to allocate 9 bytes", "f", "g", 1)),
            "out of memory");
  const auto no_thread = std::make_error_code(std::errc::resource_unavailable_try_again);
  EXPECT_NE(failureMessage(std::system_error(no_thread)).find("no thread can be started"), std::string::npos);
  EXPECT_EQ(failureMessage(std::logic_error("x > y")), "internal error: x > y");
}

template <typename Error>
void throwInAThread(const Error& error) {
  tellUncaughtErrors();
  std::thread([&error] { throw error; }).join();
}

TEST(FailureMessageDeathTest, AnErrorThatNoOneCatchesEndsTheProgramWithOneLine) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto failed = testing::ExitedWithCode(1);
  EXPECT_EXIT(throwInAThread(std::bad_alloc()), failed, "^edgeslam: out of memory\n$");
  EXPECT_EXIT(throwInAThread(InputError("a.map: is damaged")), failed, "^edgeslam: a.map: is damaged\n$");
  EXPECT_EXIT(throwInAThread(std::logic_error("x > y")), failed, "^edgeslam: internal error: x > y\n$");
  EXPECT_EXIT(throwInAThread(7), failed, "^edgeslam: internal error\n$");
}

}  // namespace
}  // namespace edgeslam
