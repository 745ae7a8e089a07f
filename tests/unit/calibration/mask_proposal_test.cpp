#include "calibration/mask_proposal.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace edgeslam {
namespace {

const cv::Size size(320, 240);
const cv::Mat no_body;

// A scene of boxes of many sizes, seen past a body; the camera moves by some pixels an image.
cv::Mat sceneAt(int image, double step) {
  cv::RNG random(7);
  cv::Mat scene(size, CV_8U, cv::Scalar(120));
  for (int box = 0; box < 400; ++box) {
    const int x = random.uniform(0, 4000), y = random.uniform(-100, 340);
    const int width = random.uniform(10, 80), height = random.uniform(10, 60), grey = random.uniform(20, 235);
    const int at = cvRound(x - step * image), lift = cvRound(20 * std::sin(0.3 * step * image / 10));
    cv::rectangle(scene, cv::Rect(at, y + lift, width, height), cv::Scalar(grey), cv::FILLED);
  }
  return scene;
}

// A plate on top: dark, with some screws.
cv::Mat plate() {
  cv::Mat body(size, CV_8U, cv::Scalar(255));
  cv::ellipse(body, {160, 0}, {180, 45}, 0, 0, 360, cv::Scalar(25), cv::FILLED);
  for (int x = 60; x < 300; x += 50) cv::circle(body, {x, 12}, 4, cv::Scalar(90), cv::FILLED);
  return body;
}

void look(EdgeChanges& changes, int images, double step, const cv::Mat& body, double gain_change = 0) {
  for (int i = 0; i < images; ++i) {
    cv::Mat image = sceneAt(i, step), noise(size, CV_16S);
    if (!body.empty()) body.copyTo(image, body < 255);
    cv::randn(noise, 0, 2);
    image.convertTo(image, CV_16S, 1 + gain_change * std::sin(0.1 * i));
    image += noise;
    image.convertTo(image, CV_8U);
    changes.add(image);
  }
}

double share(const cv::Mat& region) { return static_cast<double>(cv::countNonZero(region)) / region.total(); }

class MaskProposal : public ::testing::Test {
 protected:
  MaskProposal() { cv::theRNG().state = 1; }
};

TEST_F(MaskProposal, FindsAPlateWithItsPlainParts) {
  EdgeChanges changes;
  look(changes, 250, 7, plate(), 0.15);
  ASSERT_TRUE(changes.tellEnough()) << changes.views();
  const cv::Mat masked = changes.proposeMask() == 0, body = plate() < 255;
  EXPECT_GT(share(masked & body), 0.97 * share(body));
  cv::Mat around;
  cv::dilate(body, around, cv::getStructuringElement(cv::MORPH_RECT, {33, 33}));
  EXPECT_EQ(cv::countNonZero(masked & ~around), 0);
}

TEST_F(MaskProposal, ASceneThatPassesByIsNoBody) {
  EdgeChanges changes;
  look(changes, 250, 7, no_body);
  ASSERT_TRUE(changes.tellEnough());
  EXPECT_EQ(cv::countNonZero(changes.proposeMask() == 0), 0);
}

TEST_F(MaskProposal, ACameraThatStandsStillSaysNothing) {
  EdgeChanges changes;
  look(changes, 250, 0, plate());
  EXPECT_EQ(changes.views(), 1);
  EXPECT_FALSE(changes.tellEnough());
}

TEST_F(MaskProposal, IsOfTheSizeOfLargeImages) {
  EdgeChanges changes;
  for (int i = 0; i < 200; ++i) {
    cv::Mat image = sceneAt(i, 7);
    plate().copyTo(image, plate() < 255);
    cv::resize(image, image, {1280, 960});
    changes.add(image);
  }
  const cv::Mat masked = changes.proposeMask() == 0;
  EXPECT_EQ(masked.size(), cv::Size(1280, 960));
  EXPECT_NEAR(share(masked), share(plate() < 255), 0.06);
}

TEST_F(MaskProposal, IsDrawnInRed) {
  const cv::Mat grey(size, CV_8U, cv::Scalar(100));
  cv::Mat mask(size, CV_8U, cv::Scalar(255));
  mask.rowRange(0, 50).setTo(0);
  const cv::Mat picture = drawMask(grey, mask);
  EXPECT_EQ(picture.at<cv::Vec3b>(100, 10), cv::Vec3b(100, 100, 100));
  EXPECT_GT(picture.at<cv::Vec3b>(10, 10)[2], 170);
  EXPECT_LT(picture.at<cv::Vec3b>(10, 10)[0], 60);
}

}  // namespace
}  // namespace edgeslam
