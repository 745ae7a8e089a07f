// What the tests in the virtual machine do to vivid besides capturing from it.
#pragma once

#include <gtest/gtest.h>
#include <linux/videodev2.h>
#include <unistd.h>

#include <cctype>
#include <chrono>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>

#include "drivers/v4l2/capture_device.h"

namespace edgeslam {

inline std::int64_t now_ns() { return kernel().now_ns(); }

inline void sleep_ms(int duration) { std::this_thread::sleep_for(std::chrono::milliseconds(duration)); }

// The n-th vivid device's node, found by its bus, as numbers change when it is bound anew.
inline std::string vividNode(int number) {
  const std::string bus = "platform:vivid-00" + std::to_string(number);
  for (int i = 0; i < 16; ++i) {
    const std::string path = "/dev/video" + std::to_string(i);
    if (access(path.c_str(), F_OK) != 0) continue;
    const OpenedDevice opened = openCaptureDevice(kernel(), path);
    if (opened.device && opened.device->bus == bus) return path;
  }
  return "";
}

// Sets a control of any type, buttons included, by its name in the driver.
inline void setVivid(const std::string& path, const std::string& name, int value) {
  const OpenedDevice opened = openCaptureDevice(kernel(), path);
  ASSERT_TRUE(opened.device) << opened.problem.text;
  v4l2_queryctrl query{};
  query.id = V4L2_CTRL_FLAG_NEXT_CTRL;
  while (opened.device->device.control(VIDIOC_QUERYCTRL, &query) == 0) {
    if (name == reinterpret_cast<const char*>(query.name)) {
      v4l2_control control{query.id, value};
      ASSERT_EQ(opened.device->device.control(VIDIOC_S_CTRL, &control), 0) << name;
      return;
    }
    query.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
  }
  FAIL() << path << " has no control " << name;
}

// Takes vivid away or brings it back, as a cable does.
inline void bindVivid(bool bound) {
  std::ofstream("/sys/bus/platform/drivers/vivid/" + std::string(bound ? "bind" : "unbind")) << "vivid.0";
}

}  // namespace edgeslam
