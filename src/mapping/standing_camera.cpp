#include "mapping/standing_camera.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "mapping/points_seen_by_both.h"

namespace edgeslam {
namespace {

constexpr double still_px = 0.7, moved_px = 1.5;
// The least share of the points that is still before a standing camera, and the least share of the image's width and
// height that nine in ten of these reach over. Where things moved before a standing camera 20 to 40 % of the points
// were still; of a robot that begins to drive slowly, in coarse JPEG, 11 %.
constexpr double still_share = 0.15, reach_share = 0.4;
// Of these, what is enough for a camera that stood and was not seen to move since.
constexpr double share_again = 0.5;
// Where fewer of the still points are left, they do not say whether the camera set off.
constexpr int fewest_left = 10;

// Of nine in ten of the values, how far they lie apart.
double reachOf(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t left_out = values.size() / 20;
  return values[values.size() - 1 - left_out] - values[left_out];
}

// Calls visit(observation in the first frame, in the current one, displacement [px]).
template <typename Visit>
void forEachMotion(const InitialFrames& frames, Visit visit) {
  forEachCommon(frames.first, frames.current(), [&](std::size_t i, std::size_t j) {
    const PointObservation &before = frames.first.observations[i], &now = frames.current().observations[j];
    visit(before, now, Eigen::Vector2d(now.measurement.pixel - before.measurement.pixel));
  });
}

}  // namespace

bool StandingCamera::stands(const Camera& camera, const InitialFrames& frames) {
  if (!still_.empty()) {
    if (!hasSetOff(frames)) return true;
    forget();
    stood_ = false;
  }
  const double enough = stood_ ? share_again : 1;

  std::vector<PointId> still;
  std::vector<double> columns, rows;
  std::size_t followed = 0;
  forEachMotion(frames, [&](const PointObservation& before, const PointObservation&, const Eigen::Vector2d& motion) {
    ++followed;
    if (motion.norm() >= still_px) return;
    still.push_back(before.point);
    columns.push_back(before.measurement.pixel.x());
    rows.push_back(before.measurement.pixel.y());
  });
  if (static_cast<double>(still.size()) < enough * still_share * static_cast<double>(followed)) {
    stood_ = false;
    return false;
  }
  if (reachOf(std::move(columns)) < enough * reach_share * camera.width) return false;
  if (reachOf(std::move(rows)) < enough * reach_share * camera.height) return false;
  description_ = "the camera seems to stand: " + std::to_string(still.size()) + " of " + std::to_string(followed) +
                 " points, all over the image, did not move";
  still_ = std::move(still);
  return stood_ = true;
}

// Along its edge a point is drawn on by what moves before the camera, as its track is looked for where that would take
// it. So only corners count with their whole motion.
bool StandingCamera::hasSetOff(const InitialFrames& frames) const {
  int left = 0, moved_on = 0;
  forEachMotion(frames,
                [&](const PointObservation& before, const PointObservation& now, const Eigen::Vector2d& motion) {
                  if (!std::binary_search(still_.begin(), still_.end(), before.point)) return;
                  ++left;
                  const double moved = now.corner ? motion.norm() : std::abs(motion.dot(now.measurement.normal));
                  if (moved >= moved_px) ++moved_on;
                });
  return left >= fewest_left && 2 * moved_on > left;
}

}  // namespace edgeslam
