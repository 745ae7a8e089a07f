// The simulator's renderer: what falls on the sensor through the lens during an exposure.
//
// The image is cut into tiles. A tile that shows a single surface is shaded with few rays, all others with many, spread
// over the exposure and over a tent two pixels wide (a lens of finite sharpness), so that edges lie where they should
// to a few hundredths of a pixel. Where each row has an exposure of its own, tiles are one row high.
#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "geometry/pose.h"
#include "simulator/scene_rays.h"
#include "simulator/scene_shading.h"

namespace edgeslam {

// Radiance (CV_32F, the table's size) averaged over the poses: one or more, spread evenly over the exposure.
cv::Mat renderRadiance(const LitScene& lit, const RayTable& rays, const std::vector<Pose>& world_T_camera);

// The same of a rolling shutter: the poses are those of a row's exposure.
cv::Mat renderRowByRow(const LitScene& lit, const RayTable& rays,
                       const std::function<std::vector<Pose>(int row)>& world_T_camera);

// Mean radiance over a coarse grid of rays at one pose: what an exposure meter sees.
double meterRadiance(const LitScene& lit, const RayTable& rays, const Pose& world_T_camera);

}  // namespace edgeslam
