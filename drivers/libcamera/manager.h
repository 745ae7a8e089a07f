// The program's one CameraManager, and how formats are called.
#pragma once

#include <libcamera/camera_manager.h>
#include <libcamera/pixel_format.h>

#include <memory>
#include <optional>
#include <string>

#include "drivers/frame_capture/pixel_format.h"

namespace edgeslam {

// Started, and stopped at the end. libcamera ends the program where there are two, so a second one is refused here.
class Manager {
 public:
  Manager();
  ~Manager();
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;

  const std::string& problem() const { return problem_; }  // empty where it runs
  libcamera::CameraManager& operator*() const { return *manager_; }
  libcamera::CameraManager* operator->() const { return manager_.get(); }

 private:
  std::unique_ptr<libcamera::CameraManager> manager_;
  std::string problem_;
};

// Nothing for formats that cannot be turned to grey.
std::optional<PixelFormat> knownFormat(const libcamera::PixelFormat& format);
libcamera::PixelFormat libcameraFormat(PixelFormat format);

}  // namespace edgeslam
