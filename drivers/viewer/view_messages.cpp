#include "drivers/viewer/view_messages.h"

#include <algorithm>
#include <cmath>

#include "drivers/lcm/messages.h"
#include "drivers/viewer/message_bytes.h"
#include "image_formats/jpeg.h"

namespace edgeslam {
namespace {

using Json = nlohmann::json;

constexpr int jpeg_quality = 70;
constexpr float steps_a_pixel = 16;

// 65535 is kept for the end of a line.
std::uint16_t coordinate(float pixel) {
  const float steps = std::isfinite(pixel) ? steps_a_pixel * pixel : 0.0F;
  return static_cast<std::uint16_t>(std::clamp(steps, 0.0F, 65534.0F));
}

void appendPixel(std::string& message, const Eigen::Vector2f& pixel) {
  append(message, coordinate(pixel.x()));
  append(message, coordinate(pixel.y()));
}

std::int8_t share(float value) {
  return static_cast<std::int8_t>(std::clamp(std::isfinite(value) ? 127 * value : 0.0F, -127.0F, 127.0F));
}

void appendTrack(std::string& message, const SeenTrack& track) {
  appendPixel(message, track.pixel);
  appendPixel(message, track.keyframe_pixel);
  append(message, share(track.normal.x()));
  append(message, share(track.normal.y()));
  const int flags = (track.corner ? 1 : 0) | (track.mapped ? 2 : 0) | (track.outlier ? 4 : 0);
  append(message, static_cast<std::uint8_t>(flags));
  append(message, std::uint8_t{0});
}

void appendEdges(std::string& message, const std::vector<SeenEdgePoint>& edges) {
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i > 0 && edges[i].chain != edges[i - 1].chain) append(message, std::uint32_t{0xffffffff});
    appendPixel(message, edges[i].pixel);
  }
}

const cv::Mat& shownLevel(const ImagePyramid& pyramid) {
  std::size_t level = 0;
  while (level < 2 && level + 1 < pyramid.levels.size() && pyramid.levels[level].cols > most_picture_width) ++level;
  return pyramid.levels[level];
}

Json poseOf(const Pose& pose) {
  const Eigen::Vector3d& t = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  return {{"position", {t.x(), t.y(), t.z()}}, {"rotation", {q.x(), q.y(), q.z(), q.w()}}};
}

Json vectorOf(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

// Null where there is no unit; `up` [the map's frame, unit length] is null until gravity is known, `bias` likewise.
Json inertiaOf(const std::optional<InertialAlignment>& inertia) {
  if (!inertia) return nullptr;
  Json json{{"up", nullptr}, {"bias", nullptr}};
  if (inertia->is_known) json["up"] = vectorOf(-inertia->gravity.normalized());
  if (inertia->is_bias_known) {
    json["bias"] = {{"rate", vectorOf(inertia->bias.rate)}, {"force", vectorOf(inertia->bias.force)}};
  }
  return json;
}

Json frameOf(const FrameResult& frame) {
  Json json{{"index", frame.index},   {"utime", utimeOf(frame.time_ns)}, {"state", stateName(frame.state)},
            {"reason", frame.reason}, {"tracked", frame.tracked_points}, {"mapped", frame.mapped_points},
            {"pose", nullptr},        {"world", worldOf(frame)},         {"inertia", inertiaOf(frame.inertia)}};
  if (frame.has_pose && isFinite(frame.world_T_camera)) json["pose"] = poseOf(frame.world_T_camera);
  return json;
}

const char* scaleName(ScaleKind kind) {
  switch (kind) {
    case ScaleKind::unknown:
      break;
    case ScaleKind::known_distance:
      return "known distance";
    case ScaleKind::camera_height:
      return "camera height";
    case ScaleKind::odometry:
      return "odometry";
    case ScaleKind::inertia:
      return "inertia";
  }
  return "unknown";
}

Json statusOf(const PublisherStatus& status) {
  return {{"uptime_ms", status.uptime_ms},
          {"captured", status.frames_captured},
          {"dropped", status.frames_dropped},
          {"unreadable", status.frames_unreadable},
          {"recoveries", status.recoveries},
          {"relocalisations", status.relocalisations},
          {"loops", status.loops},
          {"mapping_queue", status.mapping_queue},
          {"keyframes", status.keyframes},
          {"points", status.points},
          {"worlds", status.worlds},
          {"recording", status.recording},
          {"camera_problem", status.camera_problem},
          {"scale_problem", status.scale_problem}};
}

}  // namespace

std::string helloMessage(const ViewerSetup& setup) {
  const Camera& camera = setup.camera;
  return beginMessage(ViewMessage::hello) + textOf({{"version", setup.version},
                                                    {"source", setup.source},
                                                    {"commands", setup.commands},
                                                    {"camera",
                                                     {{"width", camera.width},
                                                      {"height", camera.height},
                                                      {"fx", camera.fx},
                                                      {"fy", camera.fy},
                                                      {"cx", camera.cx},
                                                      {"cy", camera.cy}}}});
}

std::string stateMessage(const ViewedState& state, const std::vector<FrameSample>& samples) {
  Json frames = Json::array();
  for (const FrameSample& sample : samples) {
    frames.push_back({sample.utime, stateName(sample.state), sample.latency_ms, sample.tracking_ms});
  }
  Json json{{"frame", nullptr},
            {"samples", frames},
            {"status", statusOf(state.status)},
            {"scale",
             {{"from", scaleName(state.scale.kind)},
              {"metres_per_unit", state.scale.metres_per_unit},
              {"sigma", state.scale.sigma}}},
            {"lcm_problem", state.lcm_problem},
            {"note", state.note}};
  if (state.has_frame) json["frame"] = frameOf(state.frame);
  return beginMessage(ViewMessage::state) + textOf(json);
}

std::string pictureMessage(const FrameLook& look) {
  if (!look.images || look.images->pyramid.levels.empty()) return "";
  const cv::Mat& whole = look.images->pyramid.levels[0];
  const std::vector<unsigned char> jpeg = encodeJpeg(shownLevel(look.images->pyramid), jpeg_quality);
  std::string edges;
  appendEdges(edges, look.edges);
  std::string message = beginBinary(ViewMessage::picture, {{"index", look.index},
                                                           {"utime", utimeOf(look.time_ns)},
                                                           {"state", stateName(look.state)},
                                                           {"width", whole.cols},
                                                           {"height", whole.rows},
                                                           {"jpeg_bytes", jpeg.size()},
                                                           {"tracks", look.tracks.size()},
                                                           {"edge_points", edges.size() / 4}});
  message.append(jpeg.begin(), jpeg.end());
  for (const SeenTrack& track : look.tracks) appendTrack(message, track);
  return message + edges;
}

}  // namespace edgeslam
