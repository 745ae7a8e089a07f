// The metric scale of the world that the camera is in: set by command, come with a saved map, found by itself, or told
// by the map itself: by inertia, together with where up is, or by the wheels. Each world has its own, which is there
// again where the camera comes back. Poses go out with it, and the log is told of it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "drivers/lcm/lcm_publisher.h"
#include "map/map.h"
#include "scale/scale_from_distance.h"
#include "scale/scale_options.h"
#include "scale/scale_search.h"
#include "service/background_work.h"
#include "service/command_answers.h"
#include "service/event_log.h"

namespace edgeslam {

// For the publishing thread.
class MetricScale {
 public:
  // `body_T_camera`: translation [m]. The others outlive it; work that was begun may outlive this object.
  MetricScale(const ScaleOptions& options, const Pose& body_T_camera, LcmPublisher& publisher, BackgroundWork& work,
              EventLog& log);

  // Another map was begun: the scales were those of maps that are no more.
  void forget();
  // The next map is being looked for: lengths have no unit that is known. Those of the worlds there are stay.
  void noMap();
  // Of each frame, before it is published: poses of another world than before have that one's scale.
  void beforeFrame(const FrameResult& result);
  // A saved map is continued: what the configuration says of its scale.
  void takeConfigured();
  // By a loop: positions before and after do not go together.
  void mapWasCorrected();
  bool isKnown() const { return here().scale.kind != ScaleKind::unknown; }

  // Each frame, in order.
  void frame(const FrameResult& result);
  // Why the map does not tell it, where inertia or wheels are part of it; empty where it does.
  void mapLacks(const std::string& what) { map_lacks_ = what; }
  // The wheels', all that came, where they are its source.
  void takeOdometry();
  // A command set_scale.
  CommandOutcome set(const Command& command);

  // `seconds` since the start of the program; the map now `has_points`. True where it is wanted, to look for the
  // ground: mapCame() then.
  bool everySecond(double seconds, bool has_points);
  void mapCame(const std::shared_ptr<const Map>& map);
  // A map that was wanted does not come any more.
  void runEnded() { ground_wanted_ = false; }

  // Why it is not known, or not renewed; or empty.
  std::string problem() const;

 private:
  static constexpr int no_world = -1;

  // What inertia or the wheels in the map say, as it is known now.
  struct MapScale {
    ScaleKind kind = ScaleKind::unknown;
    double metres_a_unit = 1, sigma = 0;
  };
  struct WorldScale {
    ScaleSearch search;
    ScaleState scale{};
    GradualScale by_map{1};
    std::optional<Eigen::Vector3d> down{};  // by inertia, as it is published
    std::optional<MapScale> map{};
  };

  const WorldScale& here() const { return worlds_.at(world_); }
  WorldScale& here() { return worlds_.at(world_); }
  void begin(int world);
  void forgetWhatIsUnderWay();
  void enterWorld(const FrameResult& result);
  static std::optional<MapScale> mapScale(const FrameResult& result);
  void takeFromMap(const FrameResult& result);
  void mapKnowsNoMore();
  void takeDown(const InertialAlignment& inertia);
  void followMap();
  void take(const ScaleState& found);
  void tellProblem();

  const ScaleOptions options_;
  const Pose body_T_camera_;
  LcmPublisher& publisher_;
  BackgroundWork& work_;
  EventLog& log_;
  PositionHistory history_;
  std::map<int, WorldScale> worlds_;    // by number; that of no world yet, too
  int world_ = no_world;                // that the last pose was in
  bool ground_wanted_ = false;          // of the map that was asked for
  KeyframeId ground_keyframe_ = -1;     // the latest of the map in which it was looked for
  std::int64_t ground_looks_void_ = 0;  // counts what makes looks under way worthless
  std::string map_lacks_;
  std::set<std::string> told_problems_;  // without their numbers
};

}  // namespace edgeslam
