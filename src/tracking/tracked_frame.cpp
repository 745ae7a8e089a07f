#include "tracking/tracked_frame.h"

#include "inertia/found_time_offset.h"

namespace edgeslam {
void describe(const Camera& camera, const FollowedFrame& frame, const FrameRole& role, TrackedFrame& description) {
  description.frame_index = frame.images->frame_index;
  description.time_ns = frame.images->time_ns;
  description.world_T_camera = frame.world_T_camera;
  description.twist = frame.twist;
  description.kind = role.kind;
  description.keyframe = role.keyframe;
  description.reason = role.reason;
  description.noise_factor = role.noise_factor;
  description.world = role.world;
  description.start = role.start;
  description.inertia = InertialLink();
  description.wheels = frame.wheels;
  description.images = role.kind == FrameKind::start ? nullptr : frame.images;
  description.straight_edges.assign(frame.straight_edges.begin(), frame.straight_edges.end());
  description.felt.clear();
  description.turns.clear();
  description.observations.clear();
  for (const Track& track : frame.tracks) {
    const int straight_edge = frame.straight_edges.empty() ? -1 : track.straight_edge;
    Measurement measurement = measurementOf(track);
    if (straight_edge >= 0) measurement.sigma_tangent = sigmaAlong(track);
    const Ray ray = rayOfRow(camera, frame.twist, measurement.pixel.y(), bearing(camera, measurement.pixel));
    description.observations.push_back(
        {track.id, measurement, ray.direction, track.corner, track.chain, track.order, straight_edge});
  }
}

void reserve(std::size_t observations, bool has_inertia, TrackedFrame& description) {
  description.observations.reserve(observations);
  description.straight_edges.reserve(observations);
  if (!has_inertia) return;
  description.felt.reserve(most_felt);
  description.turns.reserve(most_turns);
}

Track trackOf(const FoundAgain& found) {
  Track track;
  track.id = found.point;
  track.pixel = track.last_keyframe_pixel = found.measurement.pixel.cast<float>();
  track.normal = found.measurement.normal.cast<float>();
  track.corner = found.corner;
  track.sigma_normal = static_cast<float>(found.measurement.sigma_normal);
  track.sigma_tangent = static_cast<float>(found.measurement.sigma_tangent);
  return track;
}

}  // namespace edgeslam
