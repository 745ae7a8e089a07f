// Whether what a run took for one straight edge is one: lines of a saved map against the true poses of its keyframes.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "evaluation/trajectory.h"
#include "geometry/median.h"
#include "map/map_file.h"
#include "mapping/line_views.h"

namespace edgeslam {

// A keyframe's pose as it was: the truth that is nearest in time.
inline Pose truePose(const Trajectory& truth, std::int64_t time_ns) {
  const auto nearer = [&](const StampedPose& a, const StampedPose& b) {
    return std::abs(a.time_ns - time_ns) < std::abs(b.time_ns - time_ns);
  };
  return std::min_element(truth.begin(), truth.end(), nearer)->world_T_camera;
}

// A view of a line from where the camera truly was.
struct TrueView {
  KeyframeId keyframe;
  EdgePlane plane;
  WorldRay from, to;
};

// By line of the map.
inline std::map<LineId, std::vector<TrueView>> trueViews(const SavedMap& saved, const Trajectory& truth) {
  std::map<LineId, std::vector<TrueView>> views;
  for (Keyframe keyframe : saved.map.keyframes) {
    keyframe.world_T_camera = truePose(truth, keyframe.time_ns);
    for (const SeenEdge& edge : keyframe.straight_edges) {
      if (edge.line < 0 || !saved.map.lines.at(edge.line).is_placed) continue;
      views[edge.line].push_back({keyframe.id, edgePlane(saved.camera, keyframe, edge),
                                  worldRay(saved.camera, keyframe, edge.from),
                                  worldRay(saved.camera, keyframe, edge.to)});
    }
  }
  return views;
}

// How far a line is from the ends of a view [rad]; large where the view shows the other side as the brighter one.
inline double misfit(const SpaceLine& line, const TrueView& view) {
  const Eigen::Vector3d normal = normalSeenFrom(line, view.plane.centre);
  if (!(normal.dot(view.plane.normal) > 0)) return M_PI;
  return std::max(std::abs(normal.dot(view.from.direction)), std::abs(normal.dot(view.to.direction)));
}

// Views that a line fits.
inline int fitting(const SpaceLine& line, const std::vector<TrueView>& views, double largest_misfit) {
  return static_cast<int>(std::count_if(views.begin(), views.end(),
                                        [&](const TrueView& view) { return misfit(line, view) < largest_misfit; }));
}

// The line on which most views agree, of those where the planes of two of them meet.
inline SpaceLine lineOfMost(const std::vector<TrueView>& views, double largest_misfit) {
  SpaceLine best;
  int most = -1;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const EdgePlane &a = views[i].plane, &b = views[j].plane;
      const Eigen::Vector3d direction = a.normal.cross(b.normal);
      const double distance = b.normal.dot(b.centre - a.centre) / b.normal.dot(a.middle);
      if (!(direction.norm() > 1e-3) || !(distance > 0)) continue;
      SpaceLine line{a.centre + distance * a.middle, direction.normalized()};
      for (int turn = 0; turn < 2; ++turn) {
        const int agree = fitting(line, views, largest_misfit);
        if (agree > most) {
          most = agree;
          best = line;
        }
        line.direction = -line.direction;
      }
    }
  }
  return best;
}

// What of a line its views show.
inline Extent extentOf(const SpaceLine& line, const std::vector<TrueView>& views) {
  Extent extent{HUGE_VAL, -HUGE_VAL};
  for (const TrueView& view : views) {
    for (const WorldRay* ray : {&view.from, &view.to}) {
      const double along = line.direction.dot(
          ray->origin + distanceAlongRay(line, ray->origin, ray->direction) * ray->direction - line.point);
      extent = {std::min(extent.begin, along), std::max(extent.end, along)};
    }
  }
  return extent;
}

// Lines of a map and how many of them are what they should be.
struct SeenLines {
  int lines = 0, views = 0;
  int pure_views = 0;  // of the edge that most views of their line are of
  int repeated = 0;    // lines of an edge that has another one

  double purity() const { return views == 0 ? 0 : static_cast<double>(pure_views) / views; }
  double completeness() const { return lines == 0 ? 0 : 1 - static_cast<double>(repeated) / lines; }
};

inline SeenLines seenLines(const SavedMap& saved, const Trajectory& truth, double largest_misfit) {
  SeenLines seen;
  std::vector<std::pair<SpaceLine, Extent>> found;
  for (const auto& [id, views] : trueViews(saved, truth)) {
    const SpaceLine line = lineOfMost(views, largest_misfit);
    ++seen.lines;
    seen.views += static_cast<int>(views.size());
    seen.pure_views += fitting(line, views, largest_misfit);
    const bool repeated = std::any_of(found.begin(), found.end(), [&](const auto& other) {
      const Extent extent = extentOf(other.first, views);
      return 2 * fitting(other.first, views, largest_misfit) > static_cast<int>(views.size()) &&
             extent.begin < other.second.end && other.second.begin < extent.end;
    });
    seen.repeated += repeated;
    found.emplace_back(line, extentOf(line, views));
  }
  return seen;
}

}  // namespace edgeslam
