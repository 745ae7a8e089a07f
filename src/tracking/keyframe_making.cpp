#include "tracking/keyframe_making.h"

#include <algorithm>
#include <cmath>

#include "geometry/angles.h"
#include "tracking/frame_preparation.h"

namespace edgeslam {
namespace {

Track trackOf(const ChosenPoint& chosen, bool weigh_edges) {
  Track track;
  track.pixel = track.keyframe_pixel = track.last_keyframe_pixel = chosen.pixel;
  track.normal = chosen.normal;
  track.corner = chosen.corner;
  track.sigma_normal = chosen.sigma_normal;
  track.sigma_tangent = weigh_edges ? chosen.sigma_tangent : chosen.sigma_normal;
  track.chain = chosen.chain;
  return track;
}

}  // namespace

// A first choice makes the workspace take what any frame of this size may need.
KeyframeMaking::KeyframeMaking(const Camera& camera, const KeyframeOptions& options, const PointSpread& spread)
    : camera_(camera), options_(options), spread_(spread) {
  occupied_.reserve(static_cast<std::size_t>(spread.count));
  chosen_.reserve(static_cast<std::size_t>(spread.count));
  const cv::Mat square = imageOfASquare(camera);
  choosePoints(square, detectEdges(square, EdgeOptions()), occupied_, spread, {}, workspace_, chosen_);
}

void KeyframeMaking::goOnFrom(KeyframeId next_keyframe, PointId next_point) {
  next_keyframe_ = next_keyframe;
  next_point_ = next_point;
}

void KeyframeMaking::choosePointsOfFirst(FollowedFrame& frame, const PointAccuracy& accuracy) {
  next_keyframe_ = first_of_world_ + 1;
  frame.tracks.clear();
  frame.world_T_camera = Pose();
  frame.twist.setZero();
  frame.inlier_count = 0;
  choosePointsIn(frame, first_of_world_, accuracy);
}

PointId KeyframeMaking::choosePointsOfSpare(FollowedFrame& frame, const PointAccuracy& accuracy) {
  const PointId first = next_point_;
  choosePointsIn(frame, -1, accuracy);
  return first;
}

KeyframeDecision KeyframeMaking::judge(const MapView& view, const FollowedFrame& frame) const {
  KeyframeEvidence evidence;
  evidence.rotation_deg =
      degrees(rotationAngle(view.keyframes.back().world_T_camera.rotation, frame.world_T_camera.rotation));
  for (const Track& track : frame.tracks)
    evidence.mean_displacement_px += (track.pixel - track.last_keyframe_pixel).norm();
  evidence.mean_displacement_px /= std::max<double>(1, static_cast<double>(frame.tracks.size()));
  evidence.tracks = static_cast<int>(frame.tracks.size());
  evidence.on_straight_edges = static_cast<int>(std::count_if(
      frame.tracks.begin(), frame.tracks.end(), [](const Track& track) { return track.straight_edge >= 0; }));
  evidence.average_tracks = average_tracks_;
  evidence.mapped = frame.inlier_count;
  evidence.mapped_at_keyframe = most_mapped_;
  evidence.seconds = static_cast<double>(frame.images->time_ns - time_ns_) * 1e-9;
  evidence.too_soon = frame.images->time_ns < earliest_ns_;
  return selectKeyframe(evidence, camera_.width, options_);
}

KeyframeId KeyframeMaking::make(FollowedFrame& frame, const PointAccuracy& accuracy) {
  for (Track& track : frame.tracks) {
    track.keyframe = next_keyframe_;
    track.keyframe_images = frame.images;
    track.keyframe_pixel = track.last_keyframe_pixel = track.pixel;
  }
  choosePointsIn(frame, next_keyframe_, accuracy);
  time_ns_ = frame.images->time_ns;
  earliest_ns_ = time_ns_ + static_cast<std::int64_t>(options_.least_interval_s * 1e9);
  frames_ = 0;
  most_mapped_ = 0;
  return next_keyframe_++;
}

void KeyframeMaking::seen(KeyframeId latest) { next_keyframe_ = std::max(next_keyframe_, latest + 1); }

void KeyframeMaking::follow(const FollowedFrame& frame) {
  most_mapped_ = std::max(most_mapped_, frame.inlier_count);
  ++frames_;
  const auto tracks = static_cast<double>(frame.tracks.size());
  average_tracks_ = average_tracks_ == 0 ? tracks : 0.95 * average_tracks_ + 0.05 * tracks;
}

void KeyframeMaking::askForOne(const FollowedFrame& last) {
  time_ns_ = earliest_ns_ = last.images->time_ns;
  frames_ = 0;
  most_mapped_ = options_.fewest_mapped * 2;
}

void KeyframeMaking::choosePointsIn(FollowedFrame& frame, KeyframeId keyframe, const PointAccuracy& accuracy) {
  occupied_.clear();
  for (const Track& track : frame.tracks) occupied_.push_back(track.pixel);
  choosePoints(frame.images->pyramid.levels[0], *frame.edges, occupied_, spread_, accuracy, workspace_, chosen_);
  for (const ChosenPoint& chosen : chosen_) {
    Track& track = frame.tracks.emplace_back(trackOf(chosen, accuracy.options.weigh_edges));
    track.id = next_point_++;
    track.order = nearestEdgePoint(*frame.edges, chosen.pixel, chosen.normal, 1.0f, -1.0f);
    track.keyframe = keyframe;
    track.keyframe_images = frame.images;
  }
}

}  // namespace edgeslam
