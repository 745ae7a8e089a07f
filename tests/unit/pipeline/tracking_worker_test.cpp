// Tracking at work before a textured plane, with mapping's answers made by hand.
#include "pipeline/tracking_worker.h"

#include <gtest/gtest.h>

#include "unit/tracking/plane_walk.h"

namespace edgeslam {
namespace {

constexpr std::int64_t long_after_ns = 900'000'000;  // the last frame's points are not looked for any more

Pose path(int i) { return walk(i); }

// The frame's result; its messages are added to `messages`.
FrameResult processFrame(TrackingWorker& worker, std::int64_t index, std::int64_t time_ns, const cv::Mat& grey,
                         std::vector<MappingMessage>& messages) {
  FrameMessages of_frame;
  const FrameResult result = worker.process(index, time_ns, grey, /*mapping_busy=*/false, of_frame);
  messages.insert(messages.end(), of_frame.begin(), of_frame.end());
  return result;
}

void take(TrackingWorker& worker, MapUpdate update) { worker.take(update); }

double distance(const Pose& a, const Pose& b) { return (a.translation - b.translation).norm(); }

// A worker that knows the plane, and all messages that it gave.
struct Followed {
  TrackingWorker worker;
  std::vector<MappingMessage> messages;
  MapUpdate update;  // the last one that it took

  // Follows the plane up to frame `last`.
  explicit Followed(int last, const Settings& settings = Settings()) : worker(walking_camera, settings) {
    process(0, 0, imageAt(0));
    update.number = update.answers = 0;
    update.view = knownMap(messages.at(0).frame);
    take(worker, update);
    for (int i = 1; i <= last; ++i) process(i, i * walking_interval_ns, imageAt(i));
  }

  FrameResult process(std::int64_t index, std::int64_t time_ns, const cv::Mat& grey) {
    return processFrame(worker, index, time_ns, grey, messages);
  }

  // Mapping knows of the messages up to `answers`; the map is as it was.
  MapUpdate& nextUpdate(std::int64_t answers) {
    ++update.number;
    update.answers = answers;
    ++update.view.version;
    update.found.reset();
    update.not_found.clear();
    return update;
  }

  std::vector<MappingMessage> questions() const {
    std::vector<MappingMessage> asked;
    for (const MappingMessage& message : messages) {
      if (message.frame.kind == FrameKind::lost) asked.push_back(message);
    }
    return asked;
  }

  // Found where frame `i` of the path is: its pose and the map points there.
  FoundFrame foundAt(std::int64_t frame_index, int i) const {
    FoundFrame found;
    found.frame_index = frame_index;
    found.world_T_camera = path(i);
    found.covariance = 1e-6 * Matrix6d::Identity();
    for (const ViewPoint& point : update.view.points) {
      const Eigen::Vector2d pixel = project(walking_camera, path(i).inverse() * worldPosition(update.view, point));
      if (!insideImage(walking_camera, pixel, 20)) continue;
      found.points.push_back({point.id, point.source_measurement, point.corner});
      found.points.back().measurement.pixel = pixel;
    }
    return found;
  }
};

TEST(TrackingWorker, BeforeTheMapEveryFrameIsAMessageAndNoneHasAPose) {
  TrackingWorker worker(walking_camera, Settings());
  std::vector<MappingMessage> messages;
  for (int i = 0; i < 4; ++i) {
    const FrameResult result = processFrame(worker, i, i * walking_interval_ns, imageAt(i), messages);
    EXPECT_EQ(result.index, i);
    EXPECT_EQ(result.time_ns, i * walking_interval_ns);
    EXPECT_EQ(result.state, TrackingState::initialising);
    EXPECT_FALSE(result.has_pose);
    EXPECT_NE(result.reason, "");
  }
  ASSERT_EQ(messages.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(messages[i].number, static_cast<std::int64_t>(i));
    EXPECT_EQ(messages[i].frame.frame_index, static_cast<std::int64_t>(i));
    EXPECT_EQ(messages[i].frame.keyframe, i == 0 ? 0 : -1);
    EXPECT_NE(messages[i].frame.kind, FrameKind::lost);
  }
}

TEST(TrackingWorker, MessagesAreNumberedOneByOneAndKeyframesNeverGoBack) {
  Settings settings;
  settings.tracking.keyframes.interval_s = 0.12;
  Followed run(3, settings);
  for (int i = 4; i < 30; ++i) {
    // Lost now and then, for frames in a row; questions are answered: not found.
    const bool lost = i % 9 == 4 || i % 9 == 5;
    run.process(i, i * walking_interval_ns, lost ? elsewhere() : imageAt(i));
    run.nextUpdate(run.messages.back().number).not_found = "it looks like nothing";
    take(run.worker, run.update);
  }
  ASSERT_GE(run.questions().size(), 3U);
  KeyframeId keyframe = -1;
  int keyframes = 0;
  for (std::size_t i = 0; i < run.messages.size(); ++i) {
    EXPECT_EQ(run.messages[i].number, static_cast<std::int64_t>(i));
    if (run.messages[i].frame.keyframe < 0) continue;
    EXPECT_GT(run.messages[i].frame.keyframe, keyframe) << i;
    keyframe = run.messages[i].frame.keyframe;
    keyframes += run.messages[i].frame.kind == FrameKind::lost ? 0 : 1;
  }
  EXPECT_GE(keyframes, 3);
  // The numbers of lost frames that were not found are nobody's.
  EXPECT_EQ(keyframe + 1, keyframes + static_cast<int>(run.questions().size()));
}

TEST(TrackingWorker, ALostFrameIsAskedForWithAllThatIsKnownOfIt) {
  Followed run(3);
  const FrameResult lost = run.process(4, 4 * walking_interval_ns, elsewhere());
  EXPECT_EQ(lost.state, TrackingState::lost);
  EXPECT_FALSE(lost.has_pose);
  EXPECT_EQ(lost.reference, -1);
  ASSERT_EQ(run.questions().size(), 1U);
  const MappingMessage& question = run.messages.back();
  EXPECT_EQ(question.frame.kind, FrameKind::lost);
  EXPECT_EQ(question.frame.frame_index, 4);
  EXPECT_GE(question.frame.keyframe, 1);
  ASSERT_TRUE(question.frame.images);
  EXPECT_EQ(question.frame.images->frame_index, 4);
  EXPECT_FALSE(question.edges->points.empty());
  ASSERT_TRUE(question.last_good_pose);
  EXPECT_LT(distance(*question.last_good_pose, path(3)), 0.001);
  EXPECT_NEAR(question.seconds_since, 1.0 / 30, 1e-6);
  EXPECT_TRUE(question.recover);
}

// Beside each point of the map ten more that are not where it has them, as after a walk behind something that moves.
void addPointsThatAreElsewhere(MapView& view) {
  const std::vector<ViewPoint> points(view.points.begin(), view.points.end());
  view.keyframes.push_back({view.keyframes.back().id + 5, view.keyframes.back().world_T_camera, nullptr});
  PointId id = 1'000'000;
  for (int copy = 0; copy < 10; ++copy) {
    for (ViewPoint point : points) {
      const double turn = 0.02 * (1 + copy % 5);  // [rad]
      point.id = id++;
      point.host_bearing =
          rotationExp(copy < 5 ? Eigen::Vector3d(turn, 0, 0) : Eigen::Vector3d(0, turn, 0)) * point.host_bearing;
      view.points.push_back(point);
    }
  }
}

TEST(TrackingWorker, APoseThatTheMapDoesNotBearOutIsLookedForInTheMapAsItWas) {
  Followed run(6);
  EXPECT_TRUE(run.questions().empty());
  addPointsThatAreElsewhere(run.nextUpdate(0).view);
  const double sigma_before = run.process(7, 7 * walking_interval_ns, imageAt(7)).world_covariance(0, 0);
  take(run.worker, run.update);
  FrameResult doubtful;
  int i = 8;
  for (; i < 25 && run.questions().empty(); ++i) doubtful = run.process(i, i * walking_interval_ns, imageAt(i));
  ASSERT_EQ(run.questions().size(), 1U);
  EXPECT_EQ(doubtful.state, TrackingState::tracking);
  EXPECT_EQ(doubtful.reason.rfind("in doubt: of ", 0), 0U) << doubtful.reason;
  EXPECT_GT(doubtful.world_covariance(0, 0), sigma_before);
  const MappingMessage question = run.questions().back();
  EXPECT_EQ(question.frame.frame_index, i - 1);
  EXPECT_EQ(question.latest_believed, 0);
  EXPECT_FALSE(question.recover);
  EXPECT_FALSE(question.starting);
  ASSERT_TRUE(question.last_good_pose);
  EXPECT_GT(question.seconds_since, 0);

  // It is asked for one answer at a time, and not with every frame; the answer holds though poses came meanwhile.
  run.process(i, i * walking_interval_ns, imageAt(i));
  EXPECT_EQ(run.questions().size(), 1U);
  MapUpdate& answer = run.nextUpdate(question.number);
  answer.found = run.foundAt(question.frame.frame_index, static_cast<int>(question.frame.frame_index));
  take(run.worker, answer);
  const FrameResult found = run.process(i + 1, (i + 1) * walking_interval_ns, imageAt(i + 1));
  EXPECT_EQ(found.state, TrackingState::relocalised);
  EXPECT_LT(distance(found.world_T_camera, path(i + 1)), 0.01);
}

TEST(TrackingWorker, OnlyOneQuestionAtATime) {
  Followed run(3);
  for (int i = 4; i < 8; ++i) {
    run.process(i, i * walking_interval_ns, elsewhere());
    // What mapping made of the messages before the question answers nothing.
    run.nextUpdate(run.questions().at(0).number - 1);
    take(run.worker, run.update);
  }
  ASSERT_EQ(run.questions().size(), 1U);
  run.nextUpdate(run.questions().at(0).number).not_found = "too few points agree";
  take(run.worker, run.update);
  const FrameResult next = run.process(8, 8 * walking_interval_ns, elsewhere());
  EXPECT_EQ(next.state, TrackingState::lost);
  EXPECT_NE(next.reason.find("too few points agree"), std::string::npos) << next.reason;
  ASSERT_EQ(run.questions().size(), 2U);
  EXPECT_EQ(run.questions().at(1).frame.frame_index, 8);
  EXPECT_NEAR(run.questions().at(1).seconds_since, 5.0 / 30, 1e-6);
}

TEST(TrackingWorker, LongAfterTheLossTheTracksAreNoHelpAnyMore) {
  Settings settings;
  settings.tracking.new_world_seconds = 1;  // none meanwhile
  Followed run(3, settings);
  for (int i = 0; i < 15; ++i) {
    run.process(4 + i, (4 + i) * walking_interval_ns, elsewhere());
    run.nextUpdate(run.messages.back().number);
    take(run.worker, run.update);
  }
  const std::vector<MappingMessage> questions = run.questions();
  ASSERT_EQ(questions.size(), 15U);
  EXPECT_TRUE(questions.front().recover);
  EXPECT_FALSE(questions.back().recover);
}

TEST(TrackingWorker, WhereNothingIsLookedForNothingIsAsked) {
  Settings settings;
  settings.relocalisation_enabled = settings.mapping.recovery_enabled = false;
  Followed run(3, settings);
  EXPECT_EQ(run.process(4, 4 * walking_interval_ns, elsewhere()).state, TrackingState::lost);
  EXPECT_TRUE(run.questions().empty());
}

class TrackingWorkerFound : public testing::TestWithParam<TrackingState> {};
INSTANTIATE_TEST_SUITE_P(How, TrackingWorkerFound,
                         testing::Values(TrackingState::recovered, TrackingState::relocalised),
                         [](const auto& how) { return std::string(stateName(how.param)); });

TEST_P(TrackingWorkerFound, TheAnswerGoesOnFromTheFrameThatWasAskedFor) {
  Settings settings;
  settings.tracking.new_world_seconds = 1;  // none meanwhile
  Followed run(3, settings);
  run.process(4, 4 * walking_interval_ns, elsewhere());
  run.nextUpdate(run.messages.back().number);
  take(run.worker, run.update);
  // Long after the loss the camera is back, but no point is followed there.
  ASSERT_EQ(run.process(90, long_after_ns, imageAt(8)).state, TrackingState::lost);
  const MappingMessage question = run.messages.back();
  ASSERT_EQ(question.frame.kind, FrameKind::lost);
  ASSERT_EQ(question.frame.frame_index, 90);
  ASSERT_EQ(run.process(91, long_after_ns + walking_interval_ns / 2, elsewhere()).state, TrackingState::lost);
  EXPECT_EQ(run.messages.back().number, question.number);

  MapUpdate& answer = run.nextUpdate(question.number);
  answer.found = run.foundAt(90, 8);
  answer.found->how = GetParam();
  ASSERT_GT(answer.found->points.size(), 50U);
  take(run.worker, answer);
  for (int i = 9; i <= 12; ++i) {
    const FrameResult result = run.process(83 + i, long_after_ns + (i - 8) * walking_interval_ns, imageAt(i));
    ASSERT_TRUE(result.has_pose) << result.reason;
    EXPECT_EQ(result.state, i == 9 ? GetParam() : TrackingState::tracking) << i;
    EXPECT_EQ(result.reason, "");
    EXPECT_LT(distance(result.world_T_camera, path(i)), 0.001) << i;
    EXPECT_GE(result.reference, 0);
    // Updates after the answer still tell of it, and are no answer any more.
    run.update.number++;
    run.update.view.version++;
    take(run.worker, run.update);
  }
  for (const MappingMessage& message : run.messages) {
    if (message.number <= question.number) continue;
    EXPECT_NE(message.frame.kind, FrameKind::lost);
    EXPECT_GT(message.frame.keyframe, question.frame.keyframe);
  }
}

// An answer that would lead tracking astray if it were taken.
FoundFrame astray(std::int64_t frame_index, const Followed& run) {
  FoundFrame found = run.foundAt(frame_index, 8);
  found.world_T_camera = Pose{rotationExp({0, 1, 0}), {5, 5, 5}};
  return found;
}

TEST(TrackingWorker, AnAnswerAfterTrackingWasRegainedIsNotUsed) {
  Followed run(3);
  ASSERT_EQ(run.process(4, 4 * walking_interval_ns, elsewhere()).state, TrackingState::lost);
  const std::int64_t question = run.messages.back().number;
  ASSERT_EQ(run.process(5, 5 * walking_interval_ns, imageAt(5)).state, TrackingState::tracking);
  MapUpdate& answer = run.nextUpdate(question);
  answer.found = astray(4, run);
  take(run.worker, answer);
  EXPECT_EQ(run.worker.tracker().view().version, answer.view.version) << "the view is taken";
  for (int i = 6; i < 9; ++i) {
    const FrameResult result = run.process(i, i * walking_interval_ns, imageAt(i));
    EXPECT_EQ(result.state, TrackingState::tracking) << result.reason;
    EXPECT_LT(distance(result.world_T_camera, path(i)), 0.001) << i;
  }
}

TEST(TrackingWorker, NorIsItWhenTrackingWasLostOnceMore) {
  Followed run(3);
  ASSERT_EQ(run.process(4, 4 * walking_interval_ns, elsewhere()).state, TrackingState::lost);
  const std::int64_t question = run.messages.back().number;
  for (int i = 5; i < 8; ++i) run.process(i, i * walking_interval_ns, imageAt(i));
  ASSERT_EQ(run.process(8, 8 * walking_interval_ns, elsewhere()).state, TrackingState::lost);
  MapUpdate& answer = run.nextUpdate(question);
  answer.found = astray(4, run);
  take(run.worker, answer);
  // Frame 4 is history: tracking goes on from frame 7.
  const FrameResult result = run.process(9, 9 * walking_interval_ns, imageAt(9));
  EXPECT_EQ(result.state, TrackingState::tracking) << result.reason;
  EXPECT_LT(distance(result.world_T_camera, path(9)), 0.001);
}

TEST(TrackingWorker, NorDoesItsReasonTellOfTheNextLoss) {
  Followed run(3);
  ASSERT_EQ(run.process(4, 4 * walking_interval_ns, elsewhere()).state, TrackingState::lost);
  const std::int64_t question = run.messages.back().number;
  ASSERT_EQ(run.process(5, 5 * walking_interval_ns, imageAt(5)).state, TrackingState::tracking);
  run.nextUpdate(question).not_found = "too few points agree";
  take(run.worker, run.update);
  const FrameResult lost = run.process(6, 6 * walking_interval_ns, elsewhere());
  EXPECT_EQ(lost.state, TrackingState::lost);
  EXPECT_EQ(lost.reason.find("too few points agree"), std::string::npos) << lost.reason;
}

TEST(TrackingWorker, AFrameThatCouldNotBeReadIsPredictedAndAsksNothing) {
  Followed run(4);
  const std::size_t messages = run.messages.size();
  const FrameResult result = run.worker.skip(5, 5 * walking_interval_ns, "frame 5 is cut off");
  EXPECT_EQ(result.index, 5);
  EXPECT_EQ(result.state, TrackingState::predicted);
  EXPECT_EQ(result.reason, "frame 5 is cut off");
  EXPECT_TRUE(result.has_pose);
  EXPECT_EQ(result.reference, -1) << "a guess is carried by no keyframe";
  EXPECT_EQ(run.messages.size(), messages);
}

TEST(TrackingWorker, InAMapMadeEarlierFramesAreLostUntilOneIsFound) {
  const Followed earlier(0);
  TrackingWorker worker(walking_camera, Settings());
  worker.goOnWith(earlier.update.view, 10'000);
  std::vector<MappingMessage> messages;
  EXPECT_EQ(processFrame(worker, 0, long_after_ns, imageAt(4), messages).state, TrackingState::lost);
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].frame.kind, FrameKind::lost);
  EXPECT_FALSE(messages[0].last_good_pose);
  EXPECT_FALSE(messages[0].recover) << "no track runs through the map's keyframes";
  MapUpdate answer = earlier.update;
  answer.answers = 0;
  answer.found = earlier.foundAt(0, 4);
  take(worker, answer);
  const FrameResult result = processFrame(worker, 1, long_after_ns + walking_interval_ns, imageAt(5), messages);
  EXPECT_EQ(result.state, TrackingState::relocalised) << result.reason;
  EXPECT_LT(distance(result.world_T_camera, path(5)), 0.001);
  for (const MappingMessage& message : messages) {
    if (message.frame.kind == FrameKind::lost) continue;
    EXPECT_GE(message.frame.observations.back().point, 10'000);
    EXPECT_GT(message.frame.keyframe, messages[0].frame.keyframe);
  }
}

}  // namespace
}  // namespace edgeslam
