// A run past a plate of the robot, which stands in every image at the same place.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "geometry/camera_mask.h"
#include "pipeline/lockstep_run.h"
#include "simulator/simulator.h"

namespace edgeslam {
namespace {

constexpr int masked_frames = 60;
constexpr int plate_rows = 50;

// Stripes and squares: more to see than on the walls.
cv::Mat plate(int width) {
  cv::Mat image(plate_rows, width, CV_8U, cv::Scalar(40));
  for (int x = 0; x + 12 <= width; x += 24) image(cv::Rect(x, 0, 12, plate_rows)).setTo(210);
  for (int x = 4; x + 4 < width; x += 12) image(cv::Rect(x, 20, 4, 6)).setTo(x % 24 == 4 ? 20 : 240);
  return image;
}

class MaskedRun : public ::testing::Test {
 protected:
  MaskedRun() {
    SimulationOptions options;
    options.scene = SceneKind::panels_textured;
    options.frames = masked_frames;
    options.width = 320;
    options.height = 240;
    sequence_ = makeSequence(options);
    mask_image_ = cv::Mat(options.height, options.width, CV_8U, cv::Scalar(255));
    mask_image_.rowRange(0, plate_rows).setTo(0);
  }

  // Past the plate. `observations_under_it`: of keyframes, under the plate.
  RunResult run(const Camera& camera, int& observations_under_it) const {
    LockstepRun lockstep(camera, Settings(), masked_frames, 0);
    for (int i = 0; i < masked_frames; ++i) {
      cv::Mat grey = sequence_.frame(i).grey;
      plate(grey.cols).copyTo(grey.rowRange(0, plate_rows));
      lockstep.process(i, sequence_.time(i), grey);
    }
    lockstep.settle();
    observations_under_it = 0;
    for (const Keyframe& keyframe : lockstep.map().keyframes) {
      for (const PointObservation& observation : keyframe.observations) {
        observations_under_it += observation.measurement.pixel.y() < plate_rows ? 1 : 0;
      }
    }
    return lockstep.finish();
  }

  // Of the frames from the first tracked one on.
  static double trackedShare(const RunResult& result) {
    int tracked = 0, all = 0;
    for (const FrameRecord& frame : result.frames) {
      const bool is_tracked = frame.state == TrackingState::tracking;
      if (all == 0 && !is_tracked) continue;
      ++all;
      tracked += is_tracked ? 1 : 0;
    }
    return all > 0 ? static_cast<double>(tracked) / all : 0;
  }

  SimulatedSequence sequence_;
  cv::Mat mask_image_;
};

TEST_F(MaskedRun, NoPointLiesUnderTheMask) {
  int under_plate = 0, under_mask = 0;
  Camera camera = sequence_.camera;
  run(camera, under_plate);
  camera.mask = makeCameraMask(mask_image_);
  const RunResult masked = run(camera, under_mask);
  EXPECT_GT(under_plate, 50) << "the case is no test of the mask";
  EXPECT_EQ(under_mask, 0);
  EXPECT_GT(trackedShare(masked), 0.95);
}

}  // namespace
}  // namespace edgeslam
