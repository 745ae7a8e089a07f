// Mapping at work: owns the map; takes tracking's messages and places' corrections, gives updates. What it is handed,
// in that order, decides all that it gives.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "mapping/mapper.h"
#include "pipeline/messages.h"
#include "pipeline/settings.h"
#include "places/relocalisation.h"

namespace edgeslam {

class MappingWorker {
 public:
  MappingWorker(const Camera& camera, const Settings& settings)
      : settings_(settings),
        mapper_(camera, mapperOptions(settings)),
        relocalisation_(camera, settings.points.accuracy, settings.relocalisation) {}

  // Before the first message: continues a map made earlier, of the same camera.
  void goOnWith(Map map);

  // The next message of tracking. No update: nothing changed that tracking is to know.
  std::optional<MapUpdate> handle(const MappingMessage& message);
  // What places made of a snapshot of the map, in the order of the snapshots.
  std::optional<MapUpdate> apply(const Correction& correction);

  // The last message brought a keyframe: the map for places.
  bool hasNewKeyframe() const { return new_keyframe_; }
  std::optional<Snapshot> snapshot() const;
  // The same without a copy: it is good until the map changes.
  std::optional<Snapshot> mapInPlace() const;
  // Number of the last message, -1 before the first.
  std::int64_t lastMessage() const { return last_message_; }
  // What was done since this was last asked.
  std::vector<MappingReport> takeReports() { return std::exchange(reports_, {}); }

  // Nothing is added to the map: it is only localised in.
  bool mapIsFrozen() const { return settings_.tracking.map_is_frozen; }
  const Mapper& mapper() const { return mapper_; }

 private:
  static MapperOptions mapperOptions(const Settings& settings);
  void updateRelocalisation();
  void tellOfCamera();
  void tellOfTimeOffset();
  void tellOfUnitRotation();
  void tellOfUnitLeftOut();
  void find(const MappingMessage& message);
  bool recover(const MappingMessage& message);
  void relocalise(const MappingMessage& message);
  void goOnFrom(TrackingState how, KeyframeId reference, const Pose& world_T_camera, const Matrix6d& covariance,
                std::vector<FoundAgain> points, const std::string& event);
  // `centre` -1: around where the camera was found, or around the latest keyframe.
  MapUpdate nextUpdate(KeyframeId centre = -1);
  std::string lackingForMetres() const;
  MappingReport& report(std::int64_t frame_index);

  Settings settings_;
  Mapper mapper_;
  Relocalisation relocalisation_;
  std::int64_t last_message_ = -1;
  std::int64_t last_frame_ = -1;          // of the last message
  std::int64_t first_valid_message_ = 0;  // what came of an earlier one is of keyframes that were given up
  bool new_keyframe_ = false;             // by the last message
  // Of the last lost frame, until tracking sends another one or goes on: updates can be passed over.
  std::optional<FoundFrame> found_;
  KeyframeId found_reference_ = -1;
  Pose found_reference_T_camera_;
  std::string not_found_;
  std::int64_t next_update_ = 0;
  std::string lacking_for_metres_;              // that was reported
  FoundCamera told_camera_;                     // what was last said to be another than the calibration's
  std::optional<std::int64_t> told_offset_ns_;  // likewise
  std::optional<Eigen::Quaterniond> told_imu_R_camera_;
  bool told_left_out_ = false;
  std::vector<MappingReport> reports_;
};

}  // namespace edgeslam
