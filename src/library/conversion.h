// The method's values as the public ones, and frames from outside checked.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "configuration/configuration.h"
#include "edgeslam/types.h"
#include "inertia/inertial_unit.h"
#include "map/map.h"
#include "tracking/frame_result.h"
#include "visual_odometry/odometry_frame.h"
#include "wheels/odometry_pose.h"

namespace edgeslam {

// Throws InputError; `calibration_file` may be empty where the configuration has one.
Configuration libraryConfiguration(const std::string& calibration_file, const std::string& configuration_file);

// The image's pixels where they are. Throws InputError where it is no image of the camera's size, or not after
// `last_time_ns`.
cv::Mat checkedImage(const GreyImage& image, const Camera& camera, std::int64_t time_ns, std::int64_t last_time_ns);
void requireLater(std::int64_t time_ns, std::int64_t last_time_ns);

// Throws InputError where no unit can have measured it.
InertialSample checkedSample(const InertialMeasurement& measurement);

// Throws InputError where wheels cannot say it.
OdometryPose checkedPose(const WheelMeasurement& measurement);

CameraPose publicPose(const Pose& world_T_camera);
int publicWorld(int world);  // of a pose
PosedFrame publicFrame(const FrameResult& result, const std::optional<OdometryFrame>& odometry);
std::vector<MapEdgePoint> publicMap(const Map& map, const Camera& camera);
// Throws InputError where the map is empty or cannot be written.
void saveLibraryMap(const std::string& path, const Camera& camera, const Map& map);

}  // namespace edgeslam
