// P23: signatures of the same place are alike, and those of others are not.
#include "places/edge_signature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "unit/places/made_place.h"

namespace edgeslam {
namespace {

EdgePoint onChain(const Eigen::Vector2d& pixel, int chain) {
  EdgePoint point;
  point.pixel = pixel.cast<float>();
  point.normal = Eigen::Vector2f::UnitX();
  point.chain = chain;
  return point;
}

// Points every 0.2 px along a lopsided open curve, turned, scaled and moved.
EdgeMap curve(double scale, double turn, const Eigen::Vector2d& offset) {
  EdgeMap edges;
  edges.chain_count = 1;
  const auto at = [](double t) {
    return Eigen::Vector2d(80 * std::cos(t) + 25 * std::sin(2 * t), 50 * std::sin(t) + 12 * t * t);
  };
  double covered = 0;
  for (double t = 0; t < 3; t += 1e-4) {
    covered += scale * (at(t + 1e-4) - at(t)).norm();
    if (covered < 0.2) continue;
    covered -= 0.2;
    const Eigen::Vector2d p = scale * (Eigen::Rotation2Dd(turn) * at(t)) + offset;
    edges.points.push_back(onChain(p, 0));
  }
  return edges;
}

EdgeSignature signatureOf(const cv::Mat& grey) { return edgeSignature(grey, detectEdges(grey, {})); }

cv::Mat roomImage(double angle) {
  Pose pose;
  pose.rotation = rotationExp({0, angle, 0});
  return test::renderRoom(3, test::placeCamera(), pose);
}

TEST(EdgeSignature, MomentsDoNotChangeWithPlaceTurnAndScale) {
  const cv::Mat grey(480, 640, CV_8U, cv::Scalar(100));
  const EdgeSignature plain = edgeSignature(grey, curve(1, 0, {200, 200}));
  for (const double scale : {0.5, 1.0, 2.0}) {
    for (const double turn : {0.0, 0.7, 2.9}) {
      const EdgeSignature moved = edgeSignature(grey, curve(scale, turn, {310, 150}));
      EXPECT_GT(momentScore(plain, moved, {}), 0.95) << "scale " << scale << ", turn " << turn;
      EXPECT_NEAR(moved.moments[0], plain.moments[0], 0.01 * plain.moments[0]);
    }
  }
}

TEST(EdgeSignature, AnotherShapeHasOtherMoments) {
  const cv::Mat grey(480, 640, CV_8U, cv::Scalar(100));
  EdgeMap line;
  for (int i = 0; i < 300; ++i) {
    line.points.push_back(onChain({100 + i, 100 + 0.2 * i}, 0));
  }
  EXPECT_LT(momentScore(edgeSignature(grey, curve(1, 0, {200, 200})), edgeSignature(grey, line), {}), 0.7);
}

TEST(EdgeSignature, CountsEdgesAndTheirPixelsInEachPart) {
  const cv::Mat grey(480, 640, CV_8U, cv::Scalar(100));
  EdgeMap edges;
  for (int chain = 0; chain < 3; ++chain) {
    for (int i = 0; i < 20; ++i) {
      edges.points.push_back(onChain({330 + i, 250 + 10 * chain}, chain));
    }
  }
  const EdgeSignature signature = edgeSignature(grey, edges);
  for (int i = 0; i < signature_parts; ++i) {
    const EdgeSignaturePart& part = signature.parts[static_cast<std::size_t>(i)];
    const bool there = i == 2 * 4 + 2;
    EXPECT_EQ(part.edges, there ? 3 : 0);
    EXPECT_DOUBLE_EQ(part.density, there ? 60.0 / (160 * 120) : 0);
  }
}

TEST(EdgeSignature, ScoresAreSymmetricAndWithinBounds) {
  std::vector<EdgeSignature> signatures;
  for (const double angle : {0.0, 0.1, 0.5, 1.5, 3.0}) signatures.push_back(signatureOf(roomImage(angle)));
  for (const EdgeSignature& first : signatures) {
    for (const EdgeSignature& second : signatures) {
      const double score = signatureScore(first, second, {});
      EXPECT_GE(score, 0);
      EXPECT_LE(score, 1);
      EXPECT_DOUBLE_EQ(score, signatureScore(second, first, {}));
      EXPECT_NEAR(thumbnailScore(first, second, 2), thumbnailScore(second, first, 2), 1e-6);
      if (&first == &second) {
        EXPECT_DOUBLE_EQ(score, 1);
        EXPECT_NEAR(thumbnailScore(first, second, 2), 1, 1e-6);
      }
    }
  }
}

TEST(EdgeSignature, ExposureDoesNotChangeTheVote) {
  const cv::Mat grey = roomImage(0.4);
  cv::Mat darker;
  grey.convertTo(darker, CV_8U, 0.8, 10);
  const EdgeSignature bright = signatureOf(grey), dark = signatureOf(darker);
  EXPECT_GT(partVote(bright, dark, {}), 0.9);
  EXPECT_GT(thumbnailScore(bright, dark, 0), 0.99);
  for (std::size_t i = 0; i < signature_parts; ++i) EXPECT_NEAR(bright.parts[i].grey, dark.parts[i].grey, 0.02);
}

TEST(EdgeSignature, ASmallTurnIsMoreLikeTheSameThanAnotherWall) {
  const EdgeSignature here = signatureOf(roomImage(0)), turned = signatureOf(roomImage(0.06)),
                      elsewhere = signatureOf(roomImage(2));
  EXPECT_GT(signatureScore(here, turned, {}), signatureScore(here, elsewhere, {}) + 0.1);
  EXPECT_GT(thumbnailScore(here, turned, 4), thumbnailScore(here, elsewhere, 4) + 0.2);
  EXPECT_GT(thumbnailScore(here, turned, 4), thumbnailScore(here, turned, 0));
}

TEST(EdgeSignature, AnImageWithoutEdges) {
  const cv::Mat grey(480, 640, CV_8U, cv::Scalar(80));
  const EdgeSignature plain = signatureOf(grey), room = signatureOf(roomImage(0));
  for (const double moment : plain.moments) EXPECT_EQ(moment, 0);
  EXPECT_EQ(thumbnailScore(plain, room, 4), 0);
  const double score = signatureScore(plain, room, {});
  EXPECT_GE(score, 0);
  EXPECT_LT(score, 0.3);
}

TEST(EdgeSignature, WhatIsMaskedDoesNotCount) {
  const cv::Mat grey = roomImage(0);
  cv::Mat other = grey.clone(), image(grey.size(), CV_8U, cv::Scalar(255));
  image.rowRange(0, grey.rows / 4).setTo(0);
  const auto mask = makeCameraMask(image);
  cv::randu(other.rowRange(0, grey.rows / 4), 0, 255);
  const auto signatureWith = [&](const cv::Mat& seen, const CameraMask* m) {
    return edgeSignature(seen, detectEdges(seen, {}, m), m);
  };
  const EdgeSignature a = signatureWith(grey, mask.get()), b = signatureWith(other, mask.get());
  EXPECT_GT(momentScore(a, b, {}), 0.999);
  EXPECT_EQ(cv::norm(a.thumbnail, b.thumbnail, cv::NORM_INF), 0);
  EXPECT_FALSE(a.parts[0].is_seen);
  EXPECT_TRUE(a.parts[4].is_seen);
  EXPECT_EQ(partVote(a, b, {}), 1);
  EXPECT_LT(signatureScore(signatureOf(grey), signatureOf(other), {}), 0.95) << "the case is no test of the mask";
}

// What every image has alike under the mask does not speak for another place.
TEST(EdgeSignature, PartsThatAreNotSeenDoNotVote) {
  EdgeSignature a = signatureOf(roomImage(0)), b = signatureOf(roomImage(1.5));
  for (std::size_t i = 0; i < 8; ++i) {
    b.parts[i] = a.parts[i];
  }
  const double with_them = partVote(a, b, {});
  for (std::size_t i = 0; i < 8; ++i) a.parts[i].is_seen = b.parts[i].is_seen = false;
  EXPECT_LT(partVote(a, b, {}), with_them);
}

}  // namespace
}  // namespace edgeslam
