#include "places/world_alignment.h"

#include <algorithm>
#include <cmath>

#include "geometry/angles.h"

namespace edgeslam {
namespace {

// Where a camera puts the worlds to each other, once the scale is known.
Similarity alignedAt(const FoundInBoth& camera, double scale) {
  const Eigen::Quaterniond rotation =
      (camera.to_T_camera.rotation * camera.from_T_camera.rotation.conjugate()).normalized();
  return {scale, rotation, camera.to_T_camera.translation - scale * (rotation * camera.from_T_camera.translation)};
}

std::vector<std::size_t> agreeingWith(const Similarity& to_S_from, const std::vector<FoundInBoth>& cameras,
                                      const WorldAlignmentOptions& options) {
  std::vector<std::size_t> agreeing;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Pose there = moved(to_S_from, cameras[i].from_T_camera);
    if (degrees(rotationAngle(there.rotation, cameras[i].to_T_camera.rotation)) > options.turn_deg) continue;
    const double apart = (there.translation - cameras[i].to_T_camera.translation).norm();
    if (apart <= options.position * cameras[i].distance) agreeing.push_back(i);
  }
  return agreeing;
}

// Of pairs of cameras, evenly chosen where there are many, the alignment that most of all agree with.
WorldAlignment bestOfPairs(const std::vector<FoundInBoth>& cameras, const WorldAlignmentOptions& options) {
  const std::size_t step = 1 + cameras.size() / options.most_paired;
  WorldAlignment best;
  for (std::size_t i = 0; i < cameras.size(); i += step) {
    for (std::size_t j = i + step; j < cameras.size(); j += step) {
      const double from = (cameras[j].from_T_camera.translation - cameras[i].from_T_camera.translation).norm();
      const double to = (cameras[j].to_T_camera.translation - cameras[i].to_T_camera.translation).norm();
      if (!(from > 0) || to < options.least_baseline * std::max(cameras[i].distance, cameras[j].distance)) continue;
      if (std::abs(std::log(to / from)) > std::log(options.largest_scale)) continue;
      const Similarity to_S_from = alignedAt(cameras[i], to / from);
      std::vector<std::size_t> agreeing = agreeingWith(to_S_from, cameras, options);
      if (agreeing.size() > best.agreeing.size()) best = {to_S_from, std::move(agreeing)};
    }
  }
  return best;
}

// Least squares over the cameras that agree. Their centres may lie along a line; what turns about it their rotations
// say.
Similarity fitted(const std::vector<FoundInBoth>& cameras, const std::vector<std::size_t>& agreeing) {
  Eigen::Vector4d turn = Eigen::Vector4d::Zero();
  Eigen::Vector3d from_centre = Eigen::Vector3d::Zero(), to_centre = Eigen::Vector3d::Zero();
  for (const std::size_t i : agreeing) {
    const Eigen::Vector4d its = alignedAt(cameras[i], 1).rotation.coeffs();
    turn += its.dot(turn) < 0 ? Eigen::Vector4d(-its) : its;
    from_centre += cameras[i].from_T_camera.translation / static_cast<double>(agreeing.size());
    to_centre += cameras[i].to_T_camera.translation / static_cast<double>(agreeing.size());
  }
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(turn).normalized();
  double products = 0, squares = 0;
  for (const std::size_t i : agreeing) {
    const Eigen::Vector3d from = rotation * (cameras[i].from_T_camera.translation - from_centre);
    products += from.dot(cameras[i].to_T_camera.translation - to_centre);
    squares += from.squaredNorm();
  }
  const double scale = products / squares;
  return {scale, rotation, to_centre - scale * (rotation * from_centre)};
}

}  // namespace

std::optional<WorldAlignment> alignWorlds(const std::vector<FoundInBoth>& cameras, const WorldAlignmentOptions& options,
                                          std::size_t& agreeing) {
  WorldAlignment alignment = bestOfPairs(cameras, options);
  agreeing = alignment.agreeing.size();
  const double fewest = std::max<double>(options.fewest, options.share * static_cast<double>(cameras.size()));
  if (static_cast<double>(agreeing) < fewest) return std::nullopt;
  const Similarity together = fitted(cameras, alignment.agreeing);
  std::vector<std::size_t> agree_with_it = agreeingWith(together, cameras, options);
  if (together.scale > 0 && agree_with_it.size() >= alignment.agreeing.size()) {
    alignment = {together, std::move(agree_with_it)};
  }
  return alignment;
}

}  // namespace edgeslam
