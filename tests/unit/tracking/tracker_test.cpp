// The tracker from frame to frame before a textured plane, with a map that is known in place of mapping's answers.
#include "tracking/tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "unit/tracking/plane_walk.h"

namespace edgeslam {
namespace {

Pose path(int i) { return walk(i); }
cv::Mat black() { return cv::Mat(walking_camera.height, walking_camera.width, CV_8U, cv::Scalar(0)); }

// What a frame came to, and what mapping is told of it.
struct Outcome : FrameResult {
  bool tells_mapping = false;
  TrackedFrame for_mapping;
};

Outcome track(Tracker& tracker, std::int64_t index, std::int64_t time_ns, const cv::Mat& grey,
              bool mapping_busy = false) {
  Outcome outcome;
  outcome.tells_mapping = tracker.track(index, time_ns, grey, mapping_busy, outcome, outcome.for_mapping);
  return outcome;
}

Outcome trackFrame(Tracker& tracker, int i) { return track(tracker, i, i * walking_interval_ns, imageAt(i)); }

TrackedFrame keepLostFrame(Tracker& tracker) {
  TrackedFrame kept;
  tracker.keepLostFrame(kept);
  return kept;
}

void adopt(Tracker& tracker, MapView view) { tracker.adopt(view); }

// A tracker that knows the plane and has followed it up to frame `last`.
struct Tracked {
  Tracker tracker;
  MapView view;
  Outcome outcome;  // of frame `last`

  explicit Tracked(int last, const TrackerOptions& options = TrackerOptions())
      : tracker{walking_camera, EdgeOptions(), PointChoiceOptions(), options} {
    outcome = trackFrame(tracker, 0);
    view = knownMap(outcome.for_mapping);
    adopt(tracker, view);
    for (int i = 1; i <= last; ++i) outcome = trackFrame(tracker, i);
  }
};

// The same map in another world frame: new_T_old, and lengths times `scale`.
MapView moved(MapView view, const Pose& new_T_old, double scale = 1) {
  for (ViewKeyframe& keyframe : view.keyframes) {
    keyframe.world_T_camera.translation *= scale;
    keyframe.world_T_camera = new_T_old * keyframe.world_T_camera;
  }
  for (ViewPoint& point : view.points) {
    point.inverse_depth /= scale;
    point.inverse_depth_sigma /= scale;
  }
  ++view.version;
  return view;
}

double distance(const Pose& a, const Pose& b) { return (a.translation - b.translation).norm(); }
double angle(const Pose& a, const Pose& b) { return rotationAngle(a.rotation, b.rotation); }

TEST(Tracker, TheFirstFrameStartsAMap) {
  Tracker tracker(walking_camera, EdgeOptions(), PointChoiceOptions(), TrackerOptions());
  const Outcome outcome = trackFrame(tracker, 0);
  EXPECT_EQ(outcome.state, TrackingState::initialising);
  EXPECT_NE(outcome.reason, "");
  EXPECT_EQ(outcome.reference, -1) << "mapping gives the frames of a start their poses";
  EXPECT_EQ(outcome.for_mapping.kind, FrameKind::first);
  ASSERT_TRUE(outcome.tells_mapping);
  const TrackedFrame& first = outcome.for_mapping;
  EXPECT_EQ(first.keyframe, 0);
  EXPECT_TRUE(first.images);
  EXPECT_GT(first.observations.size(), 100U);
  EXPECT_EQ(static_cast<int>(first.observations.size()), outcome.tracked_points);
  for (std::size_t i = 1; i < first.observations.size(); ++i) {
    EXPECT_LT(first.observations[i - 1].point, first.observations[i].point);
  }
  // Until there is a map every frame helps to start it, and none says that it is tracked.
  const Outcome second = trackFrame(tracker, 1);
  EXPECT_EQ(second.state, TrackingState::initialising);
  EXPECT_NE(second.reason, "");
  ASSERT_TRUE(second.tells_mapping);
  EXPECT_EQ(second.for_mapping.keyframe, -1);
  EXPECT_FALSE(second.for_mapping.images);
}

// Past the plane so fast that its first points leave the image: a younger frame is kept beside the first one, and
// tracking goes on from it.
TEST(Tracker, AStartWhosePointsFadeGoesOnFromASpareFrame) {
  Tracker tracker(walking_camera, EdgeOptions(), PointChoiceOptions(), TrackerOptions());
  std::vector<Outcome> outcomes;
  std::int64_t spare = -1;
  for (int i = 0; i < 70; ++i) {
    const cv::Mat image = wall().render(walking_camera, {Eigen::Quaterniond::Identity(), {0.03 * i, 0.004 * i, 0}});
    outcomes.push_back(track(tracker, i, i * walking_interval_ns, image));
    const Outcome& now = outcomes.back();
    ASSERT_EQ(now.state, TrackingState::initialising) << i;
    ASSERT_TRUE(now.tells_mapping) << i;
    if (i > 0) {
      EXPECT_NE(now.for_mapping.kind, FrameKind::first) << i << ": " << now.reason;
    }
    if (now.for_mapping.kind == FrameKind::spare && spare < 0) spare = i;
  }
  ASSERT_GT(spare, 0);
  const TrackedFrame& kept = outcomes[static_cast<std::size_t>(spare)].for_mapping;
  EXPECT_TRUE(kept.images);
  EXPECT_EQ(kept.keyframe, 0);
  EXPECT_EQ(kept.start, 0);
  EXPECT_GT(kept.observations.size(),
            1.2 * outcomes[static_cast<std::size_t>(spare) - 1].for_mapping.observations.size());
  const auto against = std::find_if(outcomes.begin(), outcomes.end(),
                                    [&](const Outcome& outcome) { return outcome.for_mapping.start == spare; });
  ASSERT_NE(against, outcomes.end());
  const TrackedFrame& frame = against->for_mapping;  // its pose is against the spare frame
  const double moved = 0.03 * static_cast<double>(frame.frame_index - spare) / wall().distance;
  EXPECT_NEAR(frame.world_T_camera.translation.x(), moved, 0.2 * moved);
}

TEST(Tracker, WhileMappingIsBusyItIsToldNothingAndTrackingGoesOn) {
  Tracked run(3);
  for (int i = 4; i < 40; ++i) {
    const Outcome outcome = track(run.tracker, i, i * walking_interval_ns, imageAt(i), /*mapping_busy=*/true);
    ASSERT_EQ(outcome.state, TrackingState::tracking) << i << ": " << outcome.reason;
    ASSERT_FALSE(outcome.tells_mapping) << i;
  }
  EXPECT_TRUE(trackFrame(run.tracker, 40).tells_mapping) << "the keyframe that was due long ago";

  Tracker unstarted(walking_camera, EdgeOptions(), PointChoiceOptions(), TrackerOptions());
  const Outcome outcome = track(unstarted, 0, 0, imageAt(0), /*mapping_busy=*/true);
  EXPECT_FALSE(outcome.tells_mapping);
  EXPECT_EQ(outcome.reason, "mapping is behind");
  EXPECT_TRUE(trackFrame(unstarted, 1).tells_mapping);
}

TEST(Tracker, NothingToSeeStartsNoMap) {
  Tracker tracker(walking_camera, EdgeOptions(), PointChoiceOptions(), TrackerOptions());
  const Outcome outcome = track(tracker, 0, 0, black());
  EXPECT_EQ(outcome.state, TrackingState::initialising);
  EXPECT_NE(outcome.reason.find("too few points"), std::string::npos) << outcome.reason;
  EXPECT_FALSE(outcome.tells_mapping);
  EXPECT_TRUE(trackFrame(tracker, 1).tells_mapping);
}

TEST(Tracker, AnotherSceneBeforeTheMapStandsStartsAnew) {
  Tracker tracker(walking_camera, EdgeOptions(), PointChoiceOptions(), TrackerOptions());
  const MapView former = knownMap(trackFrame(tracker, 0).for_mapping);
  const Outcome outcome = track(tracker, 5, 5 * walking_interval_ns, elsewhere());
  EXPECT_EQ(outcome.state, TrackingState::initialising);
  ASSERT_TRUE(outcome.tells_mapping) << outcome.reason;
  EXPECT_EQ(outcome.for_mapping.keyframe, 0);
  EXPECT_EQ(outcome.for_mapping.frame_index, 5);
  adopt(tracker, former);  // of the start that was given up
  EXPECT_FALSE(tracker.view().initialised);
  EXPECT_EQ(tracker.view().origin_frame, 5);
}

TEST(Tracker, PosesInAKnownMapAreTheTrueOnes) {
  Tracked run(0);
  for (int i = 1; i <= 6; ++i) {
    const Outcome outcome = trackFrame(run.tracker, i);
    ASSERT_EQ(outcome.state, TrackingState::tracking) << i << ": " << outcome.reason;
    EXPECT_EQ(outcome.reason, "");
    EXPECT_LT(distance(outcome.world_T_camera, path(i)), 0.001) << i;
    EXPECT_LT(angle(outcome.world_T_camera, path(i)), 0.0005) << i;
    EXPECT_GT(outcome.mapped_points, 50);
    EXPECT_GT(outcome.covariance.diagonal().minCoeff(), 0);
    const ViewKeyframe* reference = run.tracker.view().keyframes.find(outcome.reference);
    ASSERT_NE(reference, nullptr);
    EXPECT_LT(distance(reference->world_T_camera * outcome.reference_T_camera, outcome.world_T_camera), 1e-12);
  }
}

TEST(Tracker, TheSameFramesGiveTheSamePosesToTheLastBit) {
  const Tracked once(3), again(3);
  EXPECT_EQ(once.outcome.world_T_camera.translation, again.outcome.world_T_camera.translation);
  EXPECT_EQ(once.outcome.world_T_camera.rotation.coeffs(), again.outcome.world_T_camera.rotation.coeffs());
  EXPECT_EQ(once.outcome.covariance, again.outcome.covariance);
}

TEST(Tracker, AnOlderOrForeignViewIsIgnored) {
  Tracked run(2);
  Tracked undisturbed(2);
  const Pose elsewhere_pose{rotationExp({0.3, 0, 0}), {5, 0, 0}};
  MapView older = moved(run.view, elsewhere_pose);
  older.version = run.view.version;
  adopt(run.tracker, older);
  older.version = 0;
  adopt(run.tracker, older);
  MapView foreign = moved(run.view, elsewhere_pose);
  foreign.version = 1000;
  foreign.world = 1;
  foreign.keyframes = {{100, elsewhere_pose, nullptr}};
  for (ViewPoint& point : foreign.points) point.host = point.source = 100;
  adopt(run.tracker, foreign);
  EXPECT_EQ(run.tracker.view().version, run.view.version);
  const Outcome is = trackFrame(run.tracker, 3), should_be = trackFrame(undisturbed.tracker, 3);
  EXPECT_EQ(is.state, TrackingState::tracking);
  EXPECT_EQ(is.world_T_camera.translation, should_be.world_T_camera.translation);
  EXPECT_EQ(is.world_T_camera.rotation.coeffs(), should_be.world_T_camera.rotation.coeffs());
}

class TrackerMovedWith : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Scale, TrackerMovedWith, testing::Values(1.0, 1.3));

TEST_P(TrackerMovedWith, ANewerViewMovesThePosesWithTheWorld) {
  const double scale = GetParam();
  const Pose new_T_old{rotationExp({0.4, -1.1, 0.7}), {3, -2, 8}};
  Tracked run(3);
  Tracked elsewhere(3);
  adopt(run.tracker, moved(run.view, Pose()));
  adopt(elsewhere.tracker, moved(run.view, new_T_old, scale));
  EXPECT_EQ(elsewhere.tracker.view().version, run.view.version + 1);
  // Keyframes that mapping has not seen yet have moved along.
  EXPECT_EQ(elsewhere.tracker.view().keyframes.size(), run.tracker.view().keyframes.size());
  for (int i = 4; i <= 6; ++i) {
    const Outcome is = trackFrame(elsewhere.tracker, i), was = trackFrame(run.tracker, i);
    ASSERT_EQ(is.state, TrackingState::tracking) << is.reason;
    ASSERT_EQ(was.state, TrackingState::tracking) << was.reason;
    Pose should_be = was.world_T_camera;
    should_be.translation *= scale;
    should_be = new_T_old * should_be;
    const double tolerance = scale == 1 ? 1e-8 : 1e-4;  // a pixel is looked at in steps of 1/256
    EXPECT_LT(distance(is.world_T_camera, should_be), tolerance) << i;
    EXPECT_LT(angle(is.world_T_camera, should_be), tolerance) << i;
  }
}

TEST(Tracker, ABlackFrameIsPredictedAndTrackingGoesOnAfterIt) {
  Tracked run(4);
  const Outcome dark = track(run.tracker, 5, 5 * walking_interval_ns, black());
  EXPECT_EQ(dark.state, TrackingState::predicted);
  EXPECT_NE(dark.reason, "");
  EXPECT_FALSE(dark.tells_mapping);
  EXPECT_EQ(dark.mapped_points, 0);
  EXPECT_LT(distance(dark.world_T_camera, path(5)), 0.01) << "goes on as it moved";
  EXPECT_GT(dark.covariance(0, 0), run.outcome.covariance(0, 0));
  const Outcome next = trackFrame(run.tracker, 6);
  EXPECT_EQ(next.state, TrackingState::tracking) << next.reason;
  EXPECT_LT(distance(next.world_T_camera, path(6)), 0.001);
}

// By default by so much that the gate takes it for blur, and yet every point is found in it.
cv::Mat outOfFocus(const cv::Mat& image, double sigma_px = 2.5) {
  cv::Mat blurred;
  cv::GaussianBlur(image, blurred, {}, sigma_px);
  return blurred;
}

TEST(Tracker, ABlurredFrameInWhichTheMapIsFoundIsLocatedAndBecomesNoKeyframe) {
  Tracked run(4);
  const Outcome outcome = track(run.tracker, 5, 5 * walking_interval_ns, outOfFocus(imageAt(5)));
  EXPECT_EQ(outcome.state, TrackingState::tracking) << outcome.reason;
  EXPECT_FALSE(outcome.tells_mapping);
  EXPECT_LT(distance(outcome.world_T_camera, path(5)), 0.002);
  const Outcome next = trackFrame(run.tracker, 6);
  EXPECT_EQ(next.state, TrackingState::tracking) << next.reason;
  EXPECT_LT(distance(next.world_T_camera, path(6)), 0.001);
}

// By so much that hardly a point is found in it but on coarser levels. Nothing is built on what is known so.
TEST(Tracker, WhatIsTooBlurredIsFollowedCoarselyAndTheNextFrameFromTheLastSharpOne) {
  Tracked run(4);
  const Outcome outcome = track(run.tracker, 5, 5 * walking_interval_ns, outOfFocus(imageAt(5), 5));
  ASSERT_EQ(outcome.state, TrackingState::tracking) << outcome.reason;
  EXPECT_EQ(outcome.reason, "followed coarsely: blurred image");
  EXPECT_FALSE(outcome.tells_mapping);
  EXPECT_FALSE(run.tracker.hasLostFrame());
  EXPECT_LT(distance(outcome.world_T_camera, path(5)), 0.01);
  EXPECT_GT(outcome.covariance(0, 0), 2 * run.outcome.covariance(0, 0)) << "it is known less well";
  const Outcome next = trackFrame(run.tracker, 6);
  EXPECT_EQ(next.state, TrackingState::tracking) << next.reason;
  EXPECT_EQ(next.previous_time_ns, 4 * walking_interval_ns);
  EXPECT_LT(distance(next.world_T_camera, path(6)), 0.001);
}

TEST(Tracker, NothingIsFollowedForLongerThanPointsAreLookedForAfterALoss) {
  Tracked run(4);
  const TrackerOptions options;
  const auto after = [&](double seconds) { return 4 * walking_interval_ns + std::llround(1e9 * seconds); };
  EXPECT_EQ(track(run.tracker, 5, after(0.1), outOfFocus(imageAt(5), 5)).state, TrackingState::tracking);
  const std::int64_t late_ns = after(0.1 + 1.01 * options.regain_seconds);
  EXPECT_FALSE(isGoodPose(track(run.tracker, 6, late_ns, outOfFocus(imageAt(5), 5)).state));
}

TEST(Tracker, WhereBlurHidesMostTracksTheNextFrameIsFollowedFromTheLastSharpOne) {
  Tracked run(4);
  const std::size_t before = run.tracker.tracks().size();
  cv::Mat hidden = imageAt(5).clone();
  hidden(cv::Rect(0, 0, hidden.cols * 6 / 10, hidden.rows)).setTo(0);
  const Outcome outcome = track(run.tracker, 5, 5 * walking_interval_ns, hidden);
  ASSERT_EQ(outcome.state, TrackingState::tracking) << outcome.reason;
  EXPECT_LT(outcome.tracked_points, static_cast<int>(before / 2));
  EXPECT_LT(distance(outcome.world_T_camera, path(5)), 0.01);
  const Outcome next = trackFrame(run.tracker, 6);
  EXPECT_EQ(next.state, TrackingState::tracking) << next.reason;
  EXPECT_GT(next.tracked_points, static_cast<int>(before * 8 / 10));
}

TEST(Tracker, BlackForLongIsNeverTaken) {
  Tracked run(2);
  for (int i = 3; i < 40; ++i) {  // longer than the blur gate rejects frames in a row
    const Outcome outcome = track(run.tracker, i, i * walking_interval_ns, black());
    ASSERT_FALSE(isGoodPose(outcome.state)) << i;
    ASSERT_FALSE(outcome.tells_mapping) << i;
  }
}

TEST(Tracker, ThePredictedPosesDoubtGrowsWithTheTimeSince) {
  const Tracked run(4);
  Matrix6d before = run.outcome.covariance;
  double farthest = 0;
  for (const int later : {1, 2, 3, 10, 100}) {
    FrameResult outcome;
    run.tracker.skip(4 + later, (4 + later) * walking_interval_ns, "unreadable", outcome);
    EXPECT_EQ(outcome.state, TrackingState::predicted);
    EXPECT_EQ(outcome.reason, "unreadable");
    EXPECT_GT((outcome.covariance - before).diagonal().minCoeff(), 0) << later;
    before = outcome.covariance;
    farthest = std::max(farthest, distance(outcome.world_T_camera, run.outcome.world_T_camera));
  }
  EXPECT_GT(before(0, 0), 1) << "after three seconds it is anywhere";
  EXPECT_LT(farthest, 0.1) << "no flying on for ever";
}

TEST(Tracker, AnotherPlaceIsLostAndGivesNoKeyframeOfIt) {
  Tracked run(3);
  const Outcome outcome = track(run.tracker, 4, 4 * walking_interval_ns, elsewhere());
  EXPECT_EQ(outcome.state, TrackingState::lost);
  EXPECT_NE(outcome.reason, "");
  EXPECT_GT(outcome.covariance(0, 0), run.outcome.covariance(0, 0));
  EXPECT_FALSE(outcome.tells_mapping && outcome.for_mapping.frame_index == 4);
  ASSERT_TRUE(run.tracker.hasLostFrame());
  const TrackedFrame kept = keepLostFrame(run.tracker);
  EXPECT_EQ(kept.frame_index, 4);
  EXPECT_GT(kept.keyframe, run.tracker.view().keyframes.back().id);
  ASSERT_TRUE(kept.images);
  EXPECT_EQ(kept.images->frame_index, 4);
  ASSERT_EQ(track(run.tracker, 5, 5 * walking_interval_ns, elsewhere()).state, TrackingState::lost);
  EXPECT_EQ(keepLostFrame(run.tracker).keyframe, kept.keyframe + 1) << "no number twice";
  const Outcome back = trackFrame(run.tracker, 6);
  EXPECT_EQ(back.state, TrackingState::tracking) << back.reason;
  EXPECT_FALSE(run.tracker.hasLostFrame());
}

// Points in a small part of the image fix a pose less well than was asked for. What else is tracked tells how the
// camera turned.
TEST(Tracker, AnUncertainPoseIsNotBelieved) {
  const auto result = [](double largest_deviation, bool orientation_only) {
    TrackerOptions options;
    options.location.orientation_only.enabled = orientation_only;
    options.location.acceptance.least_points_share = 0;
    options.location.acceptance.largest_deviation = largest_deviation;
    Tracker tracker(walking_camera, EdgeOptions(), PointChoiceOptions(), options);
    MapView view = knownMap(trackFrame(tracker, 0).for_mapping);
    const auto is_far_off = [](const ViewPoint& point) {
      return (point.source_measurement.pixel - Eigen::Vector2d(walking_camera.width / 2.0, walking_camera.height / 2.0))
                 .norm() > 30;
    };
    view.points.erase(std::remove_if(view.points.begin(), view.points.end(), is_far_off), view.points.end());
    EXPECT_GT(view.points.size(), 6U);
    adopt(tracker, view);
    return trackFrame(tracker, 1);
  };
  const Outcome measured = result(std::numeric_limits<double>::infinity(), true);
  EXPECT_EQ(measured.state, TrackingState::tracking);
  EXPECT_EQ(measured.reason, "");
  const Outcome lost = result(1e-3, false);
  EXPECT_EQ(lost.state, TrackingState::lost);
  EXPECT_NE(lost.reason.find("the pose is uncertain by 0.0"), std::string::npos) << lost.reason;
  const Outcome held = result(1e-3, true);
  EXPECT_EQ(held.state, TrackingState::tracking);
  EXPECT_EQ(held.reason.find("orientation only"), 0U) << held.reason;
  EXPECT_LT(angle(held.world_T_camera, path(1)), 3e-3);
}

// The map points as they are measured in the frame at `pose`.
std::vector<FoundAgain> foundIn(const MapView& view, const Pose& pose, const Pose& world_T_plane) {
  std::vector<FoundAgain> found;
  for (const ViewPoint& point : view.points) {
    const Eigen::Vector3d on_plane = world_T_plane.inverse() * worldPosition(view, point);
    const Eigen::Vector2d pixel = project(walking_camera, pose.inverse() * on_plane);
    if (!insideImage(walking_camera, pixel, 20)) continue;
    found.push_back({point.id, point.source_measurement, point.corner});
    found.back().measurement.pixel = pixel;
  }
  return found;
}

// So long after a loss that the last frame's points are not looked for any more, and no world is begun yet.
TrackerOptions patient() {
  TrackerOptions options;
  options.new_world_seconds = 1;
  return options;
}

TEST(Tracker, ResumedItGoesOnInTheGivenWorld) {
  Tracked run(2, patient());
  ASSERT_EQ(track(run.tracker, 3, 3 * walking_interval_ns, elsewhere()).state, TrackingState::lost);
  const std::int64_t later_ns = 900'000'000;
  const Outcome lost = track(run.tracker, 90, later_ns, imageAt(8));
  ASSERT_EQ(lost.state, TrackingState::lost);
  ASSERT_TRUE(run.tracker.hasLostFrame());
  const TrackedFrame kept = keepLostFrame(run.tracker);
  EXPECT_EQ(kept.frame_index, 90);
  ASSERT_TRUE(kept.images);
  EXPECT_EQ(kept.images->frame_index, 90);
  EXPECT_FALSE(run.tracker.keptEdges()->points.empty());
  // Others look for it for a while.
  EXPECT_EQ(track(run.tracker, 91, later_ns + walking_interval_ns / 2, elsewhere()).state, TrackingState::lost);

  const Pose new_T_old{rotationExp({0.1, 0.9, -0.2}), {-4, 2, 1}};
  MapView view = moved(run.view, new_T_old);
  const std::uint64_t version = view.version;
  const std::vector<FoundAgain> found = foundIn(view, path(8), new_T_old);
  ASSERT_GT(found.size(), 50U);
  run.tracker.resume(view, new_T_old * path(8), 1e-6 * Matrix6d::Identity(), found);
  EXPECT_EQ(run.tracker.tracks().size(), found.size());
  EXPECT_EQ(run.tracker.view().version, version);
  for (int i = 9; i <= 11; ++i) {
    const Outcome outcome = track(run.tracker, 83 + i, later_ns + (i - 8) * walking_interval_ns, imageAt(i));
    ASSERT_EQ(outcome.state, TrackingState::tracking) << outcome.reason;
    EXPECT_FALSE(run.tracker.hasLostFrame());
    EXPECT_LT(distance(outcome.world_T_camera, new_T_old * path(i)), 0.001) << i;
    EXPECT_LT(angle(outcome.world_T_camera, new_T_old * path(i)), 0.0005) << i;
    if (outcome.tells_mapping) {
      EXPECT_GT(outcome.for_mapping.keyframe, kept.keyframe) << "after the view's and the kept frame's";
    }
  }
}

// Of the frame at `i` only a band in the middle, a fifth of its height; above and below it another place.
cv::Mat mostlyElsewhere(int i) {
  cv::Mat image = elsewhere().clone();
  const cv::Rect band(0, 2 * walking_camera.height / 5, walking_camera.width, walking_camera.height / 5);
  imageAt(i)(band).copyTo(image(band));
  return image;
}

// The answer may come long after the frame that was looked for. Where few of the points that were found are seen again,
// these may agree with a wrong pose, on which the map would grow.
TEST(Tracker, ResumedItBelievesNoPoseThatFewOfThePointsFoundAgreeWith) {
  Tracked run(2, patient());
  ASSERT_EQ(track(run.tracker, 3, 3 * walking_interval_ns, elsewhere()).state, TrackingState::lost);
  const std::int64_t later_ns = 900'000'000;
  ASSERT_EQ(track(run.tracker, 90, later_ns, imageAt(8)).state, TrackingState::lost);
  keepLostFrame(run.tracker);
  MapView view = moved(run.view, Pose());
  run.tracker.resume(view, path(8), 1e-6 * Matrix6d::Identity(), foundIn(view, path(8), Pose()));
  const Outcome few = track(run.tracker, 91, later_ns + walking_interval_ns, mostlyElsewhere(9));
  EXPECT_TRUE(few.state == TrackingState::lost || few.position_is_held) << few.reason;
}

// On coarse levels a place that looks alike agrees as well.
TEST(Tracker, ResumedItIsFollowedCoarselyOnceAFineFrameConfirmsIt) {
  Tracked run(2, patient());
  ASSERT_EQ(track(run.tracker, 3, 3 * walking_interval_ns, elsewhere()).state, TrackingState::lost);
  const std::int64_t later_ns = 900'000'000;
  ASSERT_EQ(track(run.tracker, 90, later_ns, imageAt(8)).state, TrackingState::lost);
  keepLostFrame(run.tracker);
  MapView view = moved(run.view, Pose());
  run.tracker.resume(view, path(8), 1e-6 * Matrix6d::Identity(), foundIn(view, path(8), Pose()));
  const auto trackLater = [&](int i, const cv::Mat& image) {
    return track(run.tracker, 83 + i, later_ns + (i - 8) * walking_interval_ns, image);
  };
  const Outcome unconfirmed = trackLater(9, outOfFocus(imageAt(9), 5));
  EXPECT_FALSE(isGoodPose(unconfirmed.state)) << unconfirmed.reason;
  const Outcome fine = trackLater(10, imageAt(10));
  ASSERT_EQ(fine.state, TrackingState::tracking) << fine.reason;
  const Outcome confirmed = trackLater(11, outOfFocus(imageAt(11), 5));
  EXPECT_EQ(confirmed.state, TrackingState::tracking) << confirmed.reason;
  EXPECT_EQ(confirmed.reason.find("followed coarsely: "), 0U) << confirmed.reason;
}

// The same place as another world, whose keyframes have numbers from 60 on.
MapView ofAnotherWorld(MapView view, int world) {
  view.world = world;
  const ViewKeyframe keyframe = view.keyframes.back();
  view.keyframes.clear();
  view.keyframes.push_back({60, keyframe.world_T_camera, keyframe.images, keyframe.uncertainty});
  for (ViewPoint& point : view.points) point.host = point.source = 60;
  view.latest_keyframe = 60;
  return view;
}

TEST(Tracker, LostForAQuarterOfASecondItBeginsAWorldBesideTheOldOne) {
  Tracked run(2);
  EXPECT_EQ(run.outcome.world, 0);
  const std::int64_t lost_ns = 3 * walking_interval_ns;
  const Outcome lost = track(run.tracker, 3, lost_ns, elsewhere());
  EXPECT_EQ(lost.state, TrackingState::lost);
  EXPECT_EQ(lost.world, -1);
  EXPECT_EQ(track(run.tracker, 4, lost_ns + 240'000'000, elsewhere()).state, TrackingState::lost);
  EXPECT_FALSE(run.tracker.startsBesideOthers());
  const Outcome begun = track(run.tracker, 5, lost_ns + 260'000'000, elsewhere());
  EXPECT_EQ(begun.state, TrackingState::initialising);
  EXPECT_EQ(begun.world, -1);
  ASSERT_TRUE(begun.tells_mapping);
  EXPECT_EQ(begun.for_mapping.kind, FrameKind::first);
  EXPECT_GT(begun.for_mapping.keyframe, 0);
  // And it is looked for in the old one.
  ASSERT_TRUE(run.tracker.startsBesideOthers());
  TrackedFrame asked;
  run.tracker.keepLatestFrame(asked);
  EXPECT_EQ(asked.kind, FrameKind::lost);
  EXPECT_EQ(asked.frame_index, 5);
  EXPECT_EQ(asked.world, 0);
  ASSERT_TRUE(asked.images);
  // A start that fails begins again with the same number.
  const Outcome again = track(run.tracker, 6, lost_ns + 280'000'000, black());
  const Outcome anew = track(run.tracker, 7, lost_ns + 300'000'000, imageAt(7));
  EXPECT_FALSE(again.tells_mapping);
  ASSERT_TRUE(anew.tells_mapping);
  EXPECT_EQ(anew.for_mapping.keyframe, begun.for_mapping.keyframe);
}

// As in a fast turn: the blurred frames show nothing, but what was there is still there after them.
TEST(Tracker, BlurredFramesDoNotHastenANewWorld) {
  Tracked run(9);
  cv::Mat blurred;
  cv::resize(imageAt(10), blurred, {}, 1.0 / 16, 1.0 / 16, cv::INTER_AREA);
  cv::resize(blurred, blurred, imageAt(10).size(), 0, 0, cv::INTER_LINEAR);
  const std::int64_t blurred_ns = 10 * walking_interval_ns;
  ASSERT_EQ(track(run.tracker, 10, blurred_ns, blurred).state, TrackingState::predicted);
  const std::int64_t sharp_ns = blurred_ns + 200'000'000;
  EXPECT_EQ(track(run.tracker, 11, sharp_ns, elsewhere()).state, TrackingState::lost);
  EXPECT_EQ(track(run.tracker, 12, blurred_ns + 260'000'000, elsewhere()).state, TrackingState::lost);
  EXPECT_EQ(track(run.tracker, 13, sharp_ns + 240'000'000, elsewhere()).state, TrackingState::lost);
  EXPECT_EQ(track(run.tracker, 14, sharp_ns + 260'000'000, elsewhere()).state, TrackingState::initialising);
}

// Of a frame that shows another place, and of those nearly and just over a second later.
std::vector<TrackingState> statesOfALoss(const TrackerOptions& options) {
  Tracked run(2, options);
  const std::int64_t lost_ns = 3 * walking_interval_ns;
  std::vector<TrackingState> states;
  for (const std::int64_t since_ns : {0, 990'000'000, 1'010'000'000}) {
    states.push_back(track(run.tracker, 3 + static_cast<int>(states.size()), lost_ns + since_ns, elsewhere()).state);
  }
  return states;
}

TEST(Tracker, WithAnInertialUnitANewWorldIsBegunAfterASecond) {
  TrackerOptions options;
  options.inertia = InertialUnit();
  using S = TrackingState;
  EXPECT_EQ(statesOfALoss(options), (std::vector<S>{S::lost, S::lost, S::initialising}));
}

TEST(Tracker, InAFrozenMapPosesArePredictedForASecond) {
  TrackerOptions options;
  options.map_is_frozen = true;
  using S = TrackingState;
  EXPECT_EQ(statesOfALoss(options), (std::vector<S>{S::predicted, S::predicted, S::lost}));
}

TEST(Tracker, WithoutNewWorldsItStaysLost) {
  TrackerOptions options;
  options.worlds_enabled = false;
  Tracker tracker(walking_camera, EdgeOptions(), PointChoiceOptions(), options);
  MapView view = knownMap(trackFrame(tracker, 0).for_mapping);
  tracker.adopt(view);
  ASSERT_EQ(trackFrame(tracker, 1).state, TrackingState::tracking);
  for (int i = 2; i < 10; ++i) {
    EXPECT_EQ(track(tracker, i, i * 1'000'000'000LL, elsewhere()).state, TrackingState::lost) << i;
  }
}

// Its world became part of another: the pose goes along, and so does the unit.
TEST(Tracker, JoinedToAnotherWorldItGoesOnThere) {
  Tracked run(3), alone(3);
  const Pose new_T_old{rotationExp({0.4, -1.1, 0.7}), {3, -2, 8}};
  MapView view = moved(run.view, new_T_old, 2.5);
  view.world = 7;
  adopt(run.tracker, view);
  for (int i = 4; i <= 6; ++i) {
    const Outcome is = trackFrame(run.tracker, i), was = trackFrame(alone.tracker, i);
    ASSERT_EQ(is.state, TrackingState::tracking) << is.reason;
    EXPECT_EQ(is.world, 7);
    Pose should_be = was.world_T_camera;
    should_be.translation *= 2.5;
    EXPECT_LT(distance(is.world_T_camera, new_T_old * should_be), 2e-3) << i;
  }
}

TEST(Tracker, AWorldThatItIsNotInIsNotTakenOver) {
  Tracked run(2);
  MapView other = ofAnotherWorld(run.view, 1);
  other.version = run.view.version + 5;
  adopt(run.tracker, other);
  EXPECT_EQ(run.tracker.view().world, 0);
  EXPECT_EQ(trackFrame(run.tracker, 3).world, 0);
}

}  // namespace
}  // namespace edgeslam
