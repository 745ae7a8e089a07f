// What tracking needs of a frame before it is located: its pyramid, its edges (P1 to P3) and whether it is blurred
// (P4). The memory of all frames is taken at the start.
#pragma once

#include <cstdint>

#include "edges/blur_gate.h"
#include "edges/edge_detection.h"
#include "edges/point_accuracy.h"
#include "geometry/camera.h"
#include "tracking/followed_frame.h"
#include "tracking/recycling_pool.h"
#include "tracking/stage_times.h"

namespace edgeslam {

struct PreparationOptions {
  EdgeOptions edges;
  PointAccuracyOptions accuracy;
  BlurGateOptions blur_gate;
  int pyramid_levels = 6;
};

class FramePreparation {
 public:
  FramePreparation(const Camera& camera, const PreparationOptions& options);

  // Fills `frame`: images and edges of `grey` (CV_8U of the camera's size), without tracks. False where it is blurred.
  bool prepare(std::int64_t frame_index, std::int64_t time_ns, const cv::Mat& grey, FollowedFrame& frame,
               StageClock& clock);

  // Of the last frame prepared; null before the first.
  const std::shared_ptr<const FrameImages>& latestImages() const { return latest_images_; }
  // How exactly points in it are measured, and the frames to come.
  const PointAccuracy& accuracy() const { return accuracy_; }
  // The camera is elsewhere: what was sharp there says nothing here.
  void forgetSharpness() { blur_gate_ = {}; }
  void setNoiseFactor(double factor) { accuracy_.noise_factor = factor; }

  // Makes images ready for frames to come, in place of those that keyframes keep; for another thread.
  void keepReady(int count) { image_pool_.keepReady(count); }
  // Gives up images that keyframes gave back, but for so many; likewise.
  void dropUnused(int most) { image_pool_.dropUnused(most); }

 private:
  PreparationOptions options_;
  std::shared_ptr<const CameraMask> mask_;
  RecyclingPool<FrameImages> image_pool_;
  RecyclingPool<EdgeMap> edge_pool_;
  EdgeWorkspace workspace_;
  BlurGate blur_gate_;
  PointAccuracy accuracy_;
  std::shared_ptr<const FrameImages> latest_images_;
};

// An image with edges, for workspaces that take their memory by their first use. CV_8U.
cv::Mat imageOfASquare(const Camera& camera);

}  // namespace edgeslam
