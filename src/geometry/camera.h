// Camera models: pinhole with radial-tangential distortion (Brown 1966, OpenCV's k1 k2 p1 p2 k3) and Kannala-Brandt
// fisheye (2006, OpenCV's fisheye k1..k4). Pixels are distorted image coordinates; the centre of the top-left pixel is
// (0, 0). The camera frame is x right, y down, z forward.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <memory>

namespace edgeslam {

struct CameraMask;

enum class CameraModel { pinhole_radial_tangential, kannala_brandt };

// The longest side that an image may have [px]; more is a damaged file.
constexpr int largest_camera_side = 32768;
constexpr double longest_readout_s = 0.2;  // either sign

struct Camera {
  CameraModel model = CameraModel::pinhole_radial_tangential;
  int width = 0;                                    // [px]
  int height = 0;                                   // [px]
  double fx = 0, fy = 0, cx = 0, cy = 0;            // [px]
  std::array<double, 5> distortion{0, 0, 0, 0, 0};  // radial-tangential: k1 k2 p1 p2 k3; Kannala-Brandt: k1 k2 k3 k4 0
  // From the first row's reading to the last one's [s]. 0: a global shutter; negative: rows are read from below.
  double readout_s = 0;
  // How far from the axis the distortion's polynomial counts: tangent of the angle, or for Kannala-Brandt the angle
  // itself [rad]. Farther out it goes on along its tangent (distortion_reach.h).
  double distortion_reach = std::numeric_limits<double>::infinity();
  // Where its images are not looked at (camera_mask.h); null: nowhere.
  std::shared_ptr<const CameraMask> mask = nullptr;
};

// The same calibration. The mask is none of it: a map is good with any. How far the distortion counts follows from it.
inline bool operator==(const Camera& a, const Camera& b) {
  return a.model == b.model && a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy &&
         a.cx == b.cx && a.cy == b.cy && a.distortion == b.distortion && a.readout_s == b.readout_s;
}

// Pixel of a point in the camera frame. The 2x3 derivative d pixel / d point is written where `jacobian` is given.
// Valid for points in front of the camera (z > 0 for the pinhole model); the caller checks that.
Eigen::Vector2d project(const Camera& camera, const Eigen::Vector3d& point,
                        Eigen::Matrix<double, 2, 3>* jacobian = nullptr);

// Bearing (unit vector, camera frame) of a pixel. Inverts the distortion iteratively (Newton), to 1e-10 in normalized
// units.
Eigen::Vector3d bearing(const Camera& camera, const Eigen::Vector2d& pixel);

// True where a pixel lies inside the image by at least `border` [px].
inline bool insideImage(const Camera& camera, const Eigen::Vector2d& pixel, double border = 0) {
  return pixel.x() >= border && pixel.y() >= border && pixel.x() <= camera.width - 1 - border &&
         pixel.y() <= camera.height - 1 - border;
}

// Mean focal length [px]: what converts pixels to radians where only the size matters.
inline double meanFocalLength(const Camera& camera) { return 0.5 * (camera.fx + camera.fy); }

}  // namespace edgeslam
