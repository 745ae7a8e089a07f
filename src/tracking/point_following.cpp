#include "tracking/point_following.h"

#include <algorithm>
#include <cmath>

#include "geometry/median.h"
#include "geometry/undistortion.h"

namespace edgeslam {
namespace {

constexpr double largest_move_by_distance = 0.25;  // share of the image's width

// Marks taken pixels, to find points nearer than a distance to one that was kept.
class Occupancy {
 public:
  Occupancy(int width, int height, float distance, std::size_t most, std::pmr::memory_resource* memory)
      : distance_(distance),
        columns_(width),
        rows_(height),
        cells_(static_cast<std::size_t>(width * height), -1, memory),
        kept_(memory) {
    kept_.reserve(most);
  }

  // True, and marked, where no kept point is nearer than the distance.
  bool take(const Eigen::Vector2f& pixel) {
    const int x = static_cast<int>(pixel.x()), y = static_cast<int>(pixel.y());
    const int reach = static_cast<int>(std::ceil(distance_));
    for (int v = std::max(0, y - reach); v <= std::min(rows_ - 1, y + reach); ++v) {
      for (int u = std::max(0, x - reach); u <= std::min(columns_ - 1, x + reach); ++u) {
        const int other = cells_[static_cast<std::size_t>(v * columns_ + u)];
        if (other >= 0 && (kept_[static_cast<std::size_t>(other)] - pixel).norm() < distance_) return false;
      }
    }
    cells_[static_cast<std::size_t>(y * columns_ + x)] = static_cast<std::int16_t>(kept_.size());
    kept_.push_back(pixel);
    return true;
  }

 private:
  float distance_;
  int columns_, rows_;
  std::pmr::vector<std::int16_t> cells_;
  Pixels kept_;
};

// The number of levels, from the finest on, on which the window sees nothing masked; one at least.
int clearLevels(const HiddenLevels& hidden, const Eigen::Vector2f& pixel, const Eigen::Vector2f& prediction, int most) {
  for (int level = 1; level < most; ++level) {
    const float scale = std::ldexp(1.0F, -level);
    for (const Eigen::Vector2f& place : {pixel, prediction}) {
      if (isHiddenAt(hidden, static_cast<std::size_t>(level), scale * place.x(), scale * place.y())) return level;
    }
  }
  return most;
}

bool insideImage(const cv::Mat& image, const Eigen::Vector2f& pixel, float border) {
  return pixel.x() >= border && pixel.y() >= border && pixel.x() <= static_cast<float>(image.cols - 1) - border &&
         pixel.y() <= static_cast<float>(image.rows - 1) - border;
}

}  // namespace

AlignmentPoints placeTracks(const Camera& camera, const std::vector<Track>& tracks, const MapView& view,
                            const Pose& world_T_last, double scene_depth, std::pmr::memory_resource* memory) {
  std::pmr::vector<Eigen::Vector2d> pixels(memory);
  pixels.reserve(tracks.size());
  for (const Track& track : tracks) pixels.push_back(track.pixel.cast<double>());
  std::pmr::vector<Eigen::Vector3d> bearings(tracks.size(), memory);
  bearingsOf(camera, pixels.data(), pixels.size(), bearings.data());

  const Pose last_T_world = world_T_last.inverse();
  AlignmentPoints placed(memory);
  placed.reserve(tracks.size());
  AscendingPoints points(view);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const ViewPoint* point = points.find(tracks[i].id);
    const double depth = point ? (last_T_world * worldPosition(view, *point)).norm() : scene_depth;
    placed.push_back({tracks[i].pixel, bearings[i] * depth});
  }
  return placed;
}

Pixels predictPixels(const Camera& camera, const AlignmentPoints& points, const Pose& world_T_last,
                     const Pose& world_T_predicted, std::pmr::memory_resource* memory) {
  const Pose predicted_T_world = world_T_predicted.inverse();
  const double most_by_distance = largest_move_by_distance * camera.width;
  const auto projected = [&](const AlignmentPoint& point, const Eigen::Vector3d& predicted) {
    const bool before_camera = predicted.z() > 0.01 * point.position.norm();
    return before_camera ? Eigen::Vector2f(project(camera, predicted).cast<float>()) : point.pixel;
  };
  Pixels predictions(memory);
  predictions.reserve(points.size());
  for (const AlignmentPoint& point : points) {
    const Eigen::Vector2f there = projected(point, predicted_T_world * (world_T_last * point.position));
    const Eigen::Vector2f far = projected(point, predicted_T_world.rotation * (world_T_last.rotation * point.position));
    predictions.push_back((there - far).norm() <= most_by_distance ? there : far);
  }
  return predictions;
}

double medianDepth(const std::vector<Track>& tracks, const MapView& view, const Pose& world_T_camera, double fallback,
                   std::pmr::memory_resource* memory) {
  std::pmr::vector<double> depths(memory);
  depths.reserve(tracks.size());
  AscendingPoints points(view);
  for (const Track& track : tracks) {
    if (const ViewPoint* point = points.find(track.id)) {
      depths.push_back((worldPosition(view, *point) - world_T_camera.translation).norm());
    }
  }
  return depths.empty() ? fallback : upperMedian(depths);
}

FlowMatches followPoints(const FrameImages& from, const FrameImages& to, const std::vector<Track>& tracks,
                         const Pixels& predictions, const FlowOptions& options, std::pmr::memory_resource* memory,
                         const HiddenLevels& hidden) {
  FlowMatches matches(tracks.size(), memory);
  FlowOptions clear = options;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (!hidden.empty()) clear.levels = clearLevels(hidden, tracks[i].pixel, predictions[i], options.levels);
    matches[i] = followPoint(from.pyramid, to.pyramid, tracks[i].pixel, predictions[i], clear);
  }
  return matches;
}

void filterTracks(const FrameImages& from, const FrameImages& to, const EdgeMap& edges,
                  const std::vector<Track>& tracks, const FlowMatches& matches, const FlowOptions& options,
                  std::vector<Track>& kept, std::pmr::memory_resource* memory) {
  const cv::Mat& image = to.pyramid.levels[0];
  const auto border = static_cast<float>(flowReach(options));
  const bool is_coarse = options.finest_level > 0;
  Occupancy occupancy(image.cols, image.rows, static_cast<float>(options.redundancy), tracks.size(), memory);
  kept.clear();
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const Track& track = tracks[i];
    const FlowMatch& match = matches[i];
    if (!match.found || !insideImage(image, match.pixel, border)) continue;
    // A corner-like point must come back in both directions, a point of an edge only across it.
    const float error = backwardError(from.pyramid, to.pyramid, track.pixel, match.pixel, track.normal, options);
    if (error > std::ldexp(static_cast<float>(options.forward_backward), options.finest_level)) continue;
    const float least_dot = track.corner ? -1.0f : 0.7f;
    if (!is_coarse &&
        nearestEdgePoint(edges, match.pixel, track.normal, static_cast<float>(options.edge_distance), least_dot) < 0)
      continue;
    if (!occupancy.take(match.pixel)) continue;
    kept.push_back(track);
    kept.back().pixel = match.pixel;
  }
}

}  // namespace edgeslam
