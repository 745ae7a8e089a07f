// The readout that fits best, of runs that are made up.
#include "calibration/readout_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace edgeslam {
namespace {

// Of a camera with this readout whose frames move by `pixels_a_second` on the average.
struct MadeCamera {
  double readout_s = 0.02;
  double pixels_a_second = 300;
  std::size_t frames = 600;
  double noise_px = 0.3;
  double lost_over_s = 1;  // farther off than this a run is lost after its first half

  std::vector<ReadoutTrial> operator()(const std::vector<double>& readouts_s) const {
    std::vector<ReadoutTrial> trials;
    for (const double readout : readouts_s) {
      std::mt19937 random(7);
      ReadoutTrial trial;
      trial.readout_s = readout;
      for (std::size_t i = 0; i < frames; ++i) {
        const double moves = std::abs(std::sin(0.03 * static_cast<double>(i))) * pixels_a_second;
        const double noise = noise_px * (0.8 + 0.4 * static_cast<double>(random() % 1000) / 1000);
        const bool is_lost = 2 * i > frames && std::abs(readout - readout_s) > lost_over_s;
        trial.errors.push_back(is_lost ? 0 : std::hypot(noise, 0.3 * moves * (readout - readout_s)));
      }
      trials.push_back(trial);
    }
    return trials;
  }
};

TEST(ReadoutSearch, FindsItFromBothSidesAndAtNone) {
  for (const double readout : {-0.017, 0.0, 0.0065, 0.024, 0.031}) {
    MadeCamera camera;
    camera.readout_s = readout;
    const ReadoutEstimate estimate = searchReadout(0.033, camera);
    EXPECT_EQ(estimate.problem, "");
    EXPECT_NEAR(estimate.readout_s, readout, 0.001);
    EXPECT_LT(std::abs(estimate.readout_s - readout), 3 * estimate.sigma_s);
    EXPECT_LE(estimate.error_best, estimate.error_global + 1e-9);
  }
}

TEST(ReadoutSearch, RunsThatAreLostSpeakAgainstTheirReadout) {
  MadeCamera camera;
  camera.lost_over_s = 0.009;
  const ReadoutEstimate estimate = searchReadout(0.033, camera);
  EXPECT_EQ(estimate.problem, "");
  EXPECT_NEAR(estimate.readout_s, camera.readout_s, 0.002);
}

TEST(ReadoutSearch, ACameraThatStandsDoesNotTell) {
  MadeCamera camera;
  camera.pixels_a_second = 0;
  EXPECT_NE(searchReadout(0.033, camera).problem.find("move the camera faster"), std::string::npos);
}

TEST(ReadoutSearch, TooFewFramesDoNotTell) {
  MadeCamera camera;
  camera.frames = 60;
  EXPECT_NE(searchReadout(0.033, camera).problem.find("only 60 of 60 frames"), std::string::npos);
}

// Errors that hang on the readout here in one way, there in another: no readout is right for all.
TEST(ReadoutSearch, StretchesThatContradictEachOtherDoNotTell) {
  const MadeCamera camera;
  const auto contradicting = [&](const std::vector<double>& readouts_s) {
    std::vector<ReadoutTrial> trials = camera(readouts_s);
    for (ReadoutTrial& trial : trials) {
      for (std::size_t i = 0; i < trial.errors.size(); ++i) {
        const double best = i / 60 % 2 == 0 ? 0.0 : 0.033;
        trial.errors[i] = 1 + 100 * std::abs(trial.readout_s - best);
      }
    }
    return trials;
  };
  EXPECT_NE(searchReadout(0.033, contradicting).problem, "");
}

}  // namespace
}  // namespace edgeslam
