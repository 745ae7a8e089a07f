#include "library/conversion.h"

#include <algorithm>
#include <cmath>

#include "frames/calibration_file.h"
#include "inertia/inertial_history.h"
#include "map/saved_map.h"
#include "pipeline/map_records.h"
#include "wheels/utime.h"

namespace edgeslam {
namespace {

SlamState publicState(TrackingState state) {
  switch (state) {
    case TrackingState::initialising:
      return SlamState::initialising;
    case TrackingState::tracking:
      return SlamState::tracking;
    case TrackingState::predicted:
      return SlamState::predicted;
    case TrackingState::recovered:
      return SlamState::recovered;
    case TrackingState::relocalised:
      return SlamState::relocalised;
    case TrackingState::lost:
      break;
  }
  return SlamState::lost;
}

std::array<double, 36> publicCovariance(const Matrix6d& covariance) {
  std::array<double, 36> values{};
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(values.data()) = covariance;
  return values;
}

}  // namespace

Configuration libraryConfiguration(const std::string& calibration_file, const std::string& configuration_file) {
  Configuration configuration = configuration_file.empty() ? Configuration() : readConfiguration(configuration_file);
  if (!calibration_file.empty()) {
    configuration.camera = readCalibration(calibration_file);
    configuration.settings.mapping.camera_finding.lens_is_presumed = false;
  }
  if (configuration.camera) {
    configuration.camera = asConfigured(*configuration.camera, configuration);
    configuration.settings = settingsWithSensors(configuration);
    configuration.camera = withReadoutOfUnit(*configuration.camera, configuration);
    return configuration;
  }
  throw InputError(configuration_file + ": no calibration: give one (camera.calibration)");
}

void requireLater(std::int64_t time_ns, std::int64_t last_time_ns) {
  if (time_ns > last_time_ns) return;
  throw InputError("time stamp " + std::to_string(time_ns) + " ns: expected one after the last frame's, " +
                   std::to_string(last_time_ns) + " ns");
}

cv::Mat checkedImage(const GreyImage& image, const Camera& camera, std::int64_t time_ns, std::int64_t last_time_ns) {
  if (image.width != camera.width || image.height != camera.height) {
    throw InputError("image of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                     " pixels: expected the calibration's " + std::to_string(camera.width) + " x " +
                     std::to_string(camera.height));
  }
  if (image.pixels == nullptr || image.bytes_per_row < image.width) {
    throw InputError("image without pixels, or with fewer bytes a row than pixels");
  }
  requireLater(time_ns, last_time_ns);
  // OpenCV has no constant views; nothing is written to it.
  return cv::Mat(image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.pixels),
                 static_cast<std::size_t>(image.bytes_per_row));
}

InertialSample checkedSample(const InertialMeasurement& measurement) {
  InertialSample sample;
  sample.time_ns = measurement.time_ns;
  sample.rate = Eigen::Map<const Eigen::Vector3d>(measurement.rotation_rate.data());
  sample.force = Eigen::Map<const Eigen::Vector3d>(measurement.specific_force.data());
  if (isUsable(sample)) return sample;
  throw InputError("inertial measurement of " + std::to_string(measurement.time_ns) +
                   " ns: expected finite numbers that a unit can measure, in rad/s and m/s^2");
}

OdometryPose checkedPose(const WheelMeasurement& measurement) {
  constexpr double largest_norm_error = 0.01;
  const auto& [w, x, y, z] = measurement.orientation;
  const Eigen::Quaterniond turn(w, x, y, z);
  const OdometryPose pose{utimeOf(measurement.time_ns),
                          {turn.normalized(), Eigen::Map<const Eigen::Vector3d>(measurement.position.data())}};
  if (std::abs(turn.norm() - 1) <= largest_norm_error && isUsable(pose)) return pose;
  throw InputError("wheel measurement of " + std::to_string(measurement.time_ns) +
                   " ns: expected a finite position in metres and a unit quaternion");
}

CameraPose publicPose(const Pose& world_T_camera) {
  const Eigen::Vector3d& t = world_T_camera.translation;
  const Eigen::Quaterniond& q = world_T_camera.rotation;
  return {{t.x(), t.y(), t.z()}, {q.w(), q.x(), q.y(), q.z()}};
}

// A pose whose world is not told is in the first.
int publicWorld(int world) { return std::max(0, world); }

PosedFrame publicFrame(const FrameResult& result, const std::optional<OdometryFrame>& odometry) {
  PosedFrame frame;
  frame.index = result.index;
  frame.time_ns = result.time_ns;
  frame.state = publicState(result.state);
  frame.reason = result.reason;
  frame.has_pose = result.has_pose;
  if (result.has_pose) {
    frame.world = publicWorld(result.world);
    frame.pose = publicPose(result.world_T_camera);
    frame.covariance = publicCovariance(result.covariance);
  }
  frame.has_odometry = odometry.has_value();
  if (odometry) {
    frame.odometry = publicPose(odometry->odom_T_camera);
    frame.odometry_covariance = publicCovariance(odometry->covariance);
    frame.odometry_resets = odometry->resets;
  }
  if (result.inertia && result.inertia->is_known) {
    frame.is_metric = true;
    frame.metres_per_unit = result.inertia->metres_a_unit;
    frame.scale_sigma = result.inertia->scale_sigma;
    Eigen::Map<Eigen::Vector3d>(frame.down.data()) = result.inertia->gravity.normalized();
  } else if (result.wheels.is_known) {
    frame.is_metric = true;
    frame.metres_per_unit = result.wheels.metres_a_unit;
    frame.scale_sigma = result.wheels.sigma;
  }
  frame.tracked_points = result.tracked_points;
  frame.mapped_points = result.mapped_points;
  return frame;
}

std::vector<MapEdgePoint> publicMap(const Map& map, const Camera& camera) {
  std::vector<MapEdgePoint> points;
  for (const MapPointRecord& record : mapPointRecords(map, camera)) {
    MapEdgePoint point;
    point.id = record.id;
    std::copy_n(record.position.cast<float>().eval().data(), 3, point.position.begin());
    std::copy_n(record.edge_direction.cast<float>().eval().data(), 3, point.edge_direction.begin());
    point.depth_sigma_share = record.depth_sigma_ratio;
    point.grey = record.grey;
    point.world = record.world;
    points.push_back(point);
  }
  return points;
}

void saveLibraryMap(const std::string& path, const Camera& camera, const Map& map) {
  if (map.points.empty()) throw InputError(path + ": not written, there is no map yet");
  saveMap(path, camera, map);
}

}  // namespace edgeslam
