#include "calibration/board_pose.h"

#include <vector>

#include "calibration/board_detection.h"
#include "geometry/resectioning.h"

namespace edgeslam {

std::optional<Pose> cameraBeforeBoard(const cv::Mat& grey, const Board& board, const Camera& camera) {
  constexpr double largest_error_px = 2;
  constexpr double least_share = 0.8;  // of the corners, that must fit
  const std::optional<BoardSighting> sighting = detectBoard(grey, board);
  if (!sighting) return std::nullopt;
  const std::vector<Eigen::Vector2d> all = boardCorners(board);
  Vectors3 corners, bearings;
  for (const BoardCorner& corner : sighting->corners) {
    const Eigen::Vector2d& place = all[static_cast<std::size_t>(corner.number)];
    corners.emplace_back(place.x(), place.y(), 0);
    bearings.push_back(bearing(camera, corner.pixel));
  }
  const ResectioningResult pose = resectionBySamples(corners, bearings, largest_error_px / meanFocalLength(camera), 1,
                                                     200, std::pmr::get_default_resource());
  if (!pose.found || pose.inlier_count < least_share * static_cast<double>(corners.size())) return std::nullopt;
  return pose.camera_T_world.inverse();
}

Pose fromOtherEnd(const Board& board, const Pose& board_T_camera) {
  const std::vector<Eigen::Vector2d> corners = boardCorners(board);
  const Eigen::Vector2d ends = corners.front() + corners.back();
  const Pose half_turn{Eigen::Quaterniond(0, 0, 0, 1), {ends.x(), ends.y(), 0}};
  return half_turn * board_T_camera;
}

}  // namespace edgeslam
