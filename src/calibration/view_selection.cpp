#include "calibration/view_selection.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "calibration/initial_camera.h"
#include "edgeslam/input_error.h"
#include "geometry/median.h"

namespace edgeslam {
namespace {

// Views differ where one of these does by so much.
constexpr double new_place = 0.08;     // of the image's width or height
constexpr double new_size = 0.15;      // relative
constexpr double new_tilt_rad = 0.14;  // 8 degrees
constexpr double new_roll_rad = 0.35;  // 20 degrees

double angleBetween(double a, double b) { return std::abs(std::remainder(a - b, 2 * M_PI)); }

// Median distance [px] that the corners seen in both went.
double motionBetween(const BoardSighting& a, const BoardSighting& b) {
  std::vector<double> distances;
  for (const BoardCorner& corner : a.corners) {
    const auto same = std::find_if(b.corners.begin(), b.corners.end(),
                                   [&](const BoardCorner& other) { return other.number == corner.number; });
    if (same != b.corners.end()) distances.push_back((same->pixel - corner.pixel).norm());
  }
  return medianOr(1e9, std::move(distances));
}

}  // namespace

ViewLook lookOf(const BoardSighting& sighting, const Board& board, cv::Size size, double focal_px) {
  ViewLook look;
  const std::vector<Eigen::Vector2d> places = boardCorners(board);
  std::vector<MeasuredCorner> corners;
  std::vector<cv::Point2f> pixels, hull;
  look.centre.setZero();
  for (const BoardCorner& corner : sighting.corners) {
    corners.push_back({corner.number, places[static_cast<std::size_t>(corner.number)], corner.pixel});
    pixels.emplace_back(static_cast<float>(corner.pixel.x()), static_cast<float>(corner.pixel.y()));
    look.centre += corner.pixel.cwiseQuotient(Eigen::Vector2d(size.width, size.height));
  }
  look.centre /= static_cast<double>(sighting.corners.size());
  cv::convexHull(pixels, hull);
  look.filled = cv::contourArea(hull) / size.area();
  look.size = sighting.square_px / std::max(size.width, size.height);
  Camera camera;
  camera.width = size.width;
  camera.height = size.height;
  camera.fx = camera.fy = focal_px;
  camera.cx = 0.5 * (size.width - 1);
  camera.cy = 0.5 * (size.height - 1);
  look.tilt_rad.setZero();
  if (const std::optional<Pose> pose = boardPose(camera, corners)) {
    const Eigen::Vector3d normal = pose->rotation * Eigen::Vector3d::UnitZ();
    look.tilt_rad = {-std::atan2(normal.x(), std::abs(normal.z())), -std::atan2(normal.y(), std::abs(normal.z()))};
    const Eigen::Vector3d right = pose->rotation * Eigen::Vector3d::UnitX();
    look.roll_rad = std::atan2(right.y(), right.x());
  }
  return look;
}

bool ViewSelection::isNew(const ViewLook& look) const {
  return std::none_of(views_.begin(), views_.end(), [&](const BoardView& view) {
    const ViewLook& other = view.look;
    return (look.centre - other.centre).lpNorm<Eigen::Infinity>() < new_place &&
           std::abs(std::log(look.size / other.size)) < new_size &&
           (look.tilt_rad - other.tilt_rad).lpNorm<Eigen::Infinity>() < new_tilt_rad &&
           angleBetween(look.roll_rad, other.roll_rad) < new_roll_rad;
  });
}

ViewDecision ViewSelection::take(BoardView view) {
  views_.push_back(std::move(view));
  return ViewDecision::taken;
}

ViewDecision ViewSelection::add(std::int64_t frame, std::int64_t time_ns, const cv::Mat& grey) {
  if (size_.empty()) size_ = grey.size();
  if (grey.size() != size_) {
    throw InputError("frame " + std::to_string(frame) + " has " + std::to_string(grey.cols) + " x " +
                     std::to_string(grey.rows) + " pixels, those before have " + std::to_string(size_.width) + " x " +
                     std::to_string(size_.height) + "; a calibration is for one image size");
  }
  const std::int64_t first_of_all = counts_.frames++;
  const double since_s = first_of_all == 0 ? 1e9 : static_cast<double>(time_ns - last_looked_ns_) * 1e-9;
  const bool full = views_.size() >= options_.most_views;
  if (full || (waiting_.empty() && since_s < options_.least_interval_s)) return ViewDecision::not_looked_at;
  ++counts_.looked_at;
  last_looked_ns_ = time_ns;

  const std::optional<BoardSighting> sighting = detectBoard(grey, board_);
  ViewDecision earlier = ViewDecision::not_looked_at;
  if (!waiting_.empty()) {
    BoardView view = std::move(waiting_.back());
    waiting_.clear();
    const bool soon = static_cast<double>(time_ns - view.time_ns) * 1e-9 < options_.soon_s;
    if (soon && (!sighting || motionBetween(view.sighting, *sighting) > options_.largest_motion_px)) {
      ++counts_.moving;
      earlier = ViewDecision::moving;
    } else {
      earlier = take(std::move(view));
    }
    if (soon) return earlier;
  }
  const auto tell = [&](ViewDecision decision) { return earlier == ViewDecision::taken ? earlier : decision; };
  if (!sighting) {
    ++counts_.no_board;
    last_without_board_ = grey.clone();
    return tell(ViewDecision::no_board);
  }
  if (sighting->blur_px > options_.largest_blur_px ||
      sighting->blur_px > options_.largest_blur_squares * sighting->square_px) {
    ++counts_.blurred;
    return tell(ViewDecision::blurred);
  }
  BoardView view{frame, time_ns, {}, *sighting, lookOf(*sighting, board_, size_, std::max(size_.width, size_.height))};
  if (!isNew(view.look)) {
    ++counts_.not_new;
    return tell(ViewDecision::not_new);
  }
  view.grey = grey.clone();
  waiting_.push_back(std::move(view));
  return tell(ViewDecision::waiting);
}

void ViewSelection::end() {
  if (!waiting_.empty()) take(std::move(waiting_.back()));
  waiting_.clear();
}

}  // namespace edgeslam
