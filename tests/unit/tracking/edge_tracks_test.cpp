// Tracks on the sides of a square are put onto them and told which they are on; what is a corner, or beside, stays.
#include "tracking/edge_tracks.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "unit/edges/synthetic_image.h"
#include "unit/tracking/textured_plane.h"

namespace edgeslam {
namespace {

constexpr int left = 80, right = 240, top = 60, bottom = 180;  // of a bright square: its borders, in pixels' edges

const Camera drawing_camera = cameraOfDrawing();

class EdgeTracks : public testing::Test {
 protected:
  EdgeTracks() {
    cv::Mat image(drawing_camera.height, drawing_camera.width, CV_8U, cv::Scalar(60));
    image(cv::Range(top, bottom), cv::Range(left, right)).setTo(170);
    cv::GaussianBlur(image, image, {}, 0.8);
    frame.edges = std::make_shared<EdgeMap>(detectEdges(image, EdgeOptions()));
    straight = straightEdges(drawing_camera, *frame.edges, StraightEdgeOptions());
  }

  // Five tracks on the left side and four on the upper, `off` pixels outside.
  void addTracks(float off) {
    for (int i = 0; i < 5; ++i) {
      frame.tracks.push_back(trackAt(i, {left - 0.5F - off, 90 + 15 * static_cast<float>(i)}, {1, 0}));
    }
    for (int i = 0; i < 4; ++i) {
      frame.tracks.push_back(trackAt(10 + i, {110 + 20 * static_cast<float>(i), top - 0.5F - off}, {0, 1}));
    }
  }

  FollowedFrame frame;
  StraightEdges straight;
};

TEST_F(EdgeTracks, ArePutOntoTheirEdges) {
  ASSERT_EQ(straight.size(), 4U);
  addTracks(1);
  putOnStraightEdges(drawing_camera, straight, frame);
  for (const Track& track : frame.tracks) {
    const bool is_left = track.id < 10;
    EXPECT_NEAR(is_left ? track.pixel.x() : track.pixel.y(), (is_left ? left : top) - 0.5, 0.15) << track.id;
  }
  EXPECT_NEAR(frame.tracks[2].pixel.y(), 120, 0.1) << "it moves across the edge only";
}

TEST_F(EdgeTracks, CornersAndWhatIsFarOffStayWhereTheyAre) {
  addTracks(1);
  frame.tracks[0].corner = true;
  frame.tracks[1].pixel.x() -= 4;
  frame.tracks[2].normal = {-1, 0};                // of an edge whose other side is the brighter one
  frame.tracks[3].pixel = {left - 1.5F, top + 3};  // at the end of both sides
  const std::vector<Track> before = frame.tracks;
  putOnStraightEdges(drawing_camera, straight, frame);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(frame.tracks[i].pixel, before[i].pixel) << i;
  EXPECT_NE(frame.tracks[4].pixel, before[4].pixel);
}

TEST_F(EdgeTracks, TellWhichEdgeTheyAreOn) {
  addTracks(0.3F);
  frame.tracks.push_back(trackAt(20, {150, 120}));  // in the middle of nothing
  keepStraightEdges(drawing_camera, straight, 1, frame, std::pmr::get_default_resource());
  ASSERT_EQ(frame.straight_edges.size(), 2U) << "the other two sides have no tracks";
  for (const Track& track : frame.tracks) {
    if (track.id == 20) {
      EXPECT_EQ(track.straight_edge, -1);
      continue;
    }
    ASSERT_GE(track.straight_edge, 0) << track.id;
    const SeenEdge& edge = frame.straight_edges[static_cast<std::size_t>(track.straight_edge)];
    EXPECT_EQ(edge.line, -1);
    const Eigen::Vector2d along = (edge.to.pixel - edge.from.pixel).cwiseAbs();
    EXPECT_EQ(along.y() > along.x(), track.id < 10) << track.id;
    EXPECT_LT((project(drawing_camera, edge.from.bearing) - edge.from.pixel).norm(), 1e-6);
  }
}

TEST_F(EdgeTracks, AnEdgeOfTwoTracksIsNone) {
  addTracks(0);
  frame.tracks.erase(frame.tracks.begin() + 2, frame.tracks.begin() + 5);
  keepStraightEdges(drawing_camera, straight, 1, frame, std::pmr::get_default_resource());
  ASSERT_EQ(frame.straight_edges.size(), 1U);
  for (const Track& track : frame.tracks) EXPECT_EQ(track.straight_edge, track.id < 10 ? -1 : 0) << track.id;
}

TEST_F(EdgeTracks, KnowTheirEdgesAsWellAsTheCameraMeasures) {
  addTracks(0);
  std::vector<double> sigmas;
  for (const double noise_factor : {1.0, 2.5}) {
    keepStraightEdges(drawing_camera, straight, noise_factor, frame, std::pmr::get_default_resource());
    ASSERT_FALSE(frame.straight_edges.empty());
    sigmas.push_back(frame.straight_edges[0].sigma);
  }
  EXPECT_GT(sigmas[0], 0);
  EXPECT_NEAR(sigmas[1] / sigmas[0], 2.5, 1e-9);
}

TEST_F(EdgeTracks, WithoutStraightEdgesNothingIsKept) {
  addTracks(0);
  keepStraightEdges(drawing_camera, straight, 1, frame, std::pmr::get_default_resource());
  ASSERT_FALSE(frame.straight_edges.empty());
  keepStraightEdges(drawing_camera, {}, 1, frame, std::pmr::get_default_resource());
  EXPECT_TRUE(frame.straight_edges.empty());
  for (const Track& track : frame.tracks) EXPECT_EQ(track.straight_edge, -1);
}

}  // namespace
}  // namespace edgeslam
