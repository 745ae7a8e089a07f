// A configuration and frames for the library, as its user has them.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "edgeslam/types.h"
#include "simulator/simulator.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {

struct SimulatedRobot {
  static constexpr int frame_count = 60;

  SimulatedRobot() {
    SimulationOptions options;
    options.scene = SceneKind::panels_textured;
    options.frames = frame_count;
    options.width = 320;
    options.height = 240;
    sequence = makeSequence(options);
    for (int i = 0; i < frame_count; ++i) images.push_back(sequence.frame(i).grey);
    const Camera& c = sequence.camera;
    const auto number = [](const char* key, double value) { return key + (": " + std::to_string(value)) + ", "; };
    configuration = folder.write("robot.yaml", "camera: {width: 320, height: 240, " + number("fx", c.fx) +
                                                   number("fy", c.fy) + number("cx", c.cx) + number("cy", c.cy) +
                                                   number("k1", c.distortion[0]) + number("k2", c.distortion[1]) +
                                                   number("p1", c.distortion[2]) + number("p2", c.distortion[3]) +
                                                   "k3: " + std::to_string(c.distortion[4]) + "}\n");
  }
  GreyImage image(int index) const {
    const cv::Mat& grey = images[static_cast<std::size_t>(index)];
    return {grey.data, grey.cols, grey.rows, static_cast<std::ptrdiff_t>(grey.step)};
  }

  SimulatedSequence sequence;
  std::vector<cv::Mat> images;
  TemporaryFolder folder;
  std::string configuration;
};

inline const SimulatedRobot& simulatedRobot() {
  static const SimulatedRobot robot;
  return robot;
}

}  // namespace edgeslam
