#include "calibration/initial_camera.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

namespace edgeslam {
namespace {

constexpr std::size_t most_views = 16;  // that the search looks at
constexpr double outermost = 0.17;      // least z of a bearing: 80 degrees

// Evenly over the views.
std::vector<FittedView> someOf(const std::vector<FittedView>& views) {
  if (views.size() <= most_views) return views;
  std::vector<FittedView> some;
  for (std::size_t i = 0; i < most_views; ++i) some.push_back(views[i * views.size() / most_views]);
  return some;
}

bool setPoses(const Camera& camera, std::vector<FittedView>& views) {
  for (FittedView& view : views) {
    const std::optional<Pose> pose = boardPose(camera, view.corners);
    if (!pose) return false;
    view.camera_T_board = *pose;
  }
  return true;
}

}  // namespace

std::optional<Pose> boardPose(const Camera& camera, const std::vector<MeasuredCorner>& corners) {
  std::vector<cv::Point2d> places, seen;
  for (const MeasuredCorner& corner : corners) {
    const Eigen::Vector3d b = bearing(camera, corner.pixel);
    if (!(b.z() > outermost)) continue;
    places.emplace_back(corner.place_m.x(), corner.place_m.y());
    seen.emplace_back(b.x() / b.z(), b.y() / b.z());
  }
  if (places.size() < 4) return std::nullopt;
  const cv::Mat found = cv::findHomography(places, seen);
  if (found.empty()) return std::nullopt;
  Eigen::Matrix3d h;
  for (int i = 0; i < 9; ++i) h(i / 3, i % 3) = found.at<double>(i / 3, i % 3);
  const double scale = 0.5 * (h.col(0).norm() + h.col(1).norm());
  if (!h.allFinite() || !(scale > 0)) return std::nullopt;
  h /= h(2, 2) < 0 ? -scale : scale;
  Eigen::Matrix3d axes;
  axes << h.col(0), h.col(1), h.col(0).cross(h.col(1));
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Pose pose;
  pose.rotation = Eigen::Quaterniond(Eigen::Matrix3d(svd.matrixU() * svd.matrixV().transpose())).normalized();
  pose.translation = h.col(2);
  return pose;
}

std::optional<Camera> initialCamera(CameraModel model, int width, int height, std::vector<FittedView>& views) {
  FitOptions options;
  for (const std::size_t i : {0U, 1U, 4U, 5U}) options.free[i] = true;
  options.huber = 20;  // corners are some tenths of a pixel off, the model more
  options.iterations = 15;
  std::optional<Camera> best;
  double best_cost = 0;
  const double side = std::max(width, height);
  for (double focal = 0.25 * side; focal < 5 * side; focal *= 1.3) {
    Camera camera;
    camera.model = model;
    camera.width = width;
    camera.height = height;
    camera.fx = camera.fy = focal;
    camera.cx = 0.5 * (width - 1);
    camera.cy = 0.5 * (height - 1);
    std::vector<FittedView> tried = someOf(views);
    if (!setPoses(camera, tried)) continue;
    const double cost = fitCamera(camera, tried, options).cost;
    if (!std::isfinite(cost) || (best && cost >= best_cost)) continue;
    if (!std::isfinite(camera.fx) || camera.fx > 20 * side || camera.fx < 0.05 * side) continue;
    best = camera;
    best_cost = cost;
  }
  if (!best || !setPoses(*best, views)) return std::nullopt;
  return best;
}

}  // namespace edgeslam
