#include "simulator/simulator.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "edgeslam/input_error.h"
#include "files/format_text.h"
#include "geometry/angles.h"
#include "geometry/rolling_shutter.h"
#include "simulator/scene_lighting.h"

namespace edgeslam {
namespace {

constexpr std::int64_t first_time_ns = 1'000'000'000'000;
constexpr int default_frames = 300;
constexpr double covered_light = 0.012;  // share of the light that a hand on the lens lets through
constexpr double blur_step_px = 1.2;     // an edge moves at most about so far between two poses of an exposure
constexpr int fewest_poses = 5;
constexpr int most_poses = 41;

void checkRange(const char* option, double value, double least, double most) {
  if (value >= least && value <= most) return;
  throw InputError(formatted("simulate: %s is %g, expected %g to %g", option, value, least, most));
}

void checkRanges(const char* option, const std::vector<FrameRange>& ranges, int frames) {
  for (const FrameRange& range : ranges) {
    if (range.first >= 0 && range.count > 0 && range.first < frames && range.count <= frames - range.first) continue;
    throw InputError(std::string("simulate: ") + option + " " + std::to_string(range.first) + ":" +
                     std::to_string(range.count) + " is not within the sequence's frames 0 to " +
                     std::to_string(frames - 1));
  }
}

void checkOptions(const SimulationOptions& options) {
  checkRange("frames", options.frames, 0, 1'000'000);
  checkRange("fps", options.fps, 1, 1000);
  checkRange("width", options.width, 64, 4096);
  checkRange("height", options.height, 64, 4096);
  checkRange("noise", options.noise, 0, 60);
  checkRange("exposure", options.exposure_ms, 0, 1000 / options.fps);
  checkRange("turn-angle", options.turn_deg, -180, 180);
  checkRange("readout", options.readout_ms, -1e3 * longest_readout_s, 1e3 * longest_readout_s);
  const double interval_ms = 1000 / options.fps;
  if (std::abs(options.readout_ms) > interval_ms) {
    throw InputError(formatted("simulate: readout is %g ms, longer than the %g ms from one frame to the next",
                               options.readout_ms, interval_ms));
  }
  checkRange("speed", options.speed, 0.05, 10);
}

Camera makeCamera(const SimulationOptions& options) {
  Camera camera;
  camera.width = options.width;
  camera.height = options.height;
  camera.readout_s = 1e-3 * options.readout_ms;
  // Lenses for 640 x 480, scaled so that the field of view covers the larger image side as there.
  const double scale = std::max(options.width / 640.0, options.height / 480.0);
  const double middle_x = 0.5 * (options.width - 1), middle_y = 0.5 * (options.height - 1);
  camera.cx = middle_x + 1.3 * scale;
  camera.cy = middle_y + 4.1 * scale;
  if (options.fisheye) {
    camera.model = CameraModel::kannala_brandt;
    camera.fx = 330 * scale;
    camera.fy = 330.4 * scale;
    camera.distortion = {-0.012, 0.009, -0.006, 0.0012, 0};
  } else if (isCorridor(options.scene)) {
    camera.fx = 421 * scale;
    camera.fy = 421.6 * scale;
    camera.distortion = {-0.245, 0.055, 0.0004, -0.0006, 0};
  } else {
    camera.fx = 530 * scale;
    camera.fy = 532 * scale;
    camera.distortion = {0.045, -0.11, -0.0012, 0.0007, 0};
  }
  return camera;
}

double frameTime(const SimulationOptions& options, int index) { return index / options.fps; }

std::vector<TimeSpan> timeSpans(const std::vector<FrameRange>& ranges, double fps) {
  std::vector<TimeSpan> spans;
  for (const FrameRange& range : ranges) {
    // Half an interval more at each end: the whole exposure of every frame lies inside, or nearly so where the readout
    // is about as long as the interval.
    spans.push_back({(range.first - 0.5) / fps, (range.first + range.count - 0.5) / fps});
  }
  return spans;
}

bool isIn(const std::vector<FrameRange>& ranges, int index) {
  return std::any_of(ranges.begin(), ranges.end(), [index](const FrameRange& range) { return range.contains(index); });
}

// Poses spread evenly over the exposure about `time_s`, the more the faster the image moves; the middle one is at
// `time_s`.
std::vector<Pose> exposurePoses(const SimulatedSequence& sequence, double time_s) {
  const double exposure_s = 1e-3 * sequence.options.exposure_ms;
  const Pose begin = poseAt(sequence.motion, time_s - 0.5 * exposure_s),
             end = poseAt(sequence.motion, time_s + 0.5 * exposure_s);
  // As if everything were 1 m away.
  const double blur_px = meanFocalLength(sequence.camera) *
                         (rotationAngle(begin.rotation, end.rotation) + (end.translation - begin.translation).norm());
  const int half = static_cast<int>(std::ceil(0.5 * blur_px / blur_step_px));
  const int count = std::clamp(2 * half + 1, fewest_poses, most_poses);
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    poses.push_back(poseAt(sequence.motion, time_s + exposure_s * ((i + 0.5) / count - 0.5)));
  }
  return poses;
}

cv::Mat radianceAt(const SimulatedSequence& sequence, double time_s) {
  const Camera& camera = sequence.camera;
  if (camera.readout_s == 0) return renderRadiance(sequence.scene, sequence.rays, exposurePoses(sequence, time_s));
  return renderRowByRow(sequence.scene, sequence.rays,
                        [&](int row) { return exposurePoses(sequence, time_s + rowTime(camera, row)); });
}

}  // namespace

FrameRange parseFrameRange(const std::string& text) {
  FrameRange range;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, range.first);
  if (first.ec == std::errc() && first.ptr != end && *first.ptr == ':') {
    const auto count = std::from_chars(first.ptr + 1, end, range.count);
    if (count.ec == std::errc() && count.ptr == end && range.first >= 0 && range.count > 0) return range;
  }
  throw InputError("simulate: '" + text + "' is no frame range: expected FIRST:COUNT, such as 120:20");
}

std::int64_t SimulatedSequence::time(int index) const {
  return first_time_ns + static_cast<std::int64_t>(std::llround(1e9 * frameTime(options, index)));
}

Pose SimulatedSequence::groundTruth(int index) const { return poseAt(motion, frameTime(options, index)); }

SimulatedFrame SimulatedSequence::frame(int index) const {
  if (index < 0 || index >= size()) throw std::out_of_range("SimulatedSequence::frame");
  const cv::Mat radiance = radianceAt(*this, frameTime(options, index));
  const double light = isIn(options.covered, index) ? covered_light : 1;
  SensorOptions sensor;
  sensor.noise = options.noise;
  const std::uint64_t noise_seed = options.seed * 0x9E3779B97F4A7C15U + static_cast<std::uint64_t>(index) + 1;
  const double gain = light * gains[static_cast<std::size_t>(index)];
  return {time(index), senseImage(radiance, gain, sensor, noise_seed), groundTruth(index)};
}

SimulatedSequence makeSequence(const SimulationOptions& options) {
  checkOptions(options);
  SimulatedSequence sequence;
  sequence.options = options;
  int& frames = sequence.options.frames;
  if (frames == 0) {
    frames = default_frames;
    if (isCorridor(options.scene)) {
      const double lap_s = lapTime(makeCameraMotion(options.scene, options.speed, options.seed, 0));
      frames = static_cast<int>(std::ceil((lap_s + 1.5 / options.speed) * options.fps));
    }
  }
  checkRanges("cover", options.covered, frames);
  checkRanges("shake", options.shaken, frames);
  checkRanges("still", options.still, frames);
  checkRanges("turn", options.turned, frames);

  sequence.camera = makeCamera(options);
  sequence.rays = makeRayTable(sequence.camera);
  sequence.scene.scene = makeScene(options.scene, options.seed);
  sequence.scene.light = computeLight(sequence.scene.scene);
  sequence.motion = makeCameraMotion(options.scene, options.speed, options.seed, frameTime(options, frames));
  sequence.motion.shaken = timeSpans(options.shaken, options.fps);
  sequence.motion.still = timeSpans(options.still, options.fps);
  sequence.motion.turned = timeSpans(options.turned, options.fps);
  sequence.motion.turn_rad = radians(options.turn_deg);
  sequence.motion.still.insert(sequence.motion.still.end(), sequence.motion.turned.begin(),
                               sequence.motion.turned.end());

  std::vector<double> means;
  for (int i = 0; i < frames; ++i) {
    const double mean = meterRadiance(sequence.scene, sequence.rays, sequence.groundTruth(i));
    means.push_back(isIn(options.covered, i) ? covered_light * mean : mean);
  }
  sequence.gains = automaticGains(means, 1 / options.fps);
  return sequence;
}

}  // namespace edgeslam
