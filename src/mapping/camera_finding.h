// What the map says of the camera that its calibration does not, or says wrongly: how long a rolling shutter reads its
// rows, how long the focal length is, how the lens distorts, and where its axis is. With another camera the rays of the
// keyframes do not meet as well, so that their adjustment costs more.
//
// How the camera moved while a keyframe was read is told by the poses of frames, which err as long as the readout is
// not known. So what is found is too small at first. The frames to come are better, and what is found from them is
// nearer: it is looked for again every few keyframes, until it stays.
#pragma once

#include <vector>

#include "geometry/found_camera.h"
#include "mapping/camera_looks.h"
#include "mapping/camera_trial.h"

namespace edgeslam {

struct CameraFindingOptions {
  bool is_enabled = true;
  bool readout_is_known = false;  // that of the calibration counts, also where it is 0
  bool lens_is_presumed = false;  // there is no calibration: the lens may be far off
  int fewest_keyframes = 12;      // of a world
  int interval = 2;               // keyframes from one look to the next, until something is found ...
  int interval_found = 4;         // ... and then ...
  int interval_resting = 12;      // ... and after so many looks that found nothing that it may be known
  int longest_wait = 12;          // of the lens for a readout that is being found: with a wrong lens none comes to stay
  int most_keyframes = 24;        // the latest so many are looked at ...
  int most_keyframes_found = 48;  // ... and once another lens was found: one motion tells of it what another does not
  int most_looks = 50;
  int whole_map = 60;  // keyframes of a world that are all adjusted by what was found; of more the latest are
};

class CameraFinding {
 public:
  explicit CameraFinding(const CameraFindingOptions& options) : options_(options) {
    readout_.is_settled = options.readout_is_known;
  }

  // After a keyframe was added to the latest keyframe's world. True where the camera was found to be another one:
  // `map.found` says so, and the map is adjusted to it. `calibrated`: without what was found.
  bool look(const Camera& calibrated, const GlobalAdjustmentOptions& global, const LocalAdjustmentOptions& local,
            Map& map);

  // What is found came to stay, and what is not is looked for now and then at most.
  bool readoutIsSettled() const;
  bool lensIsSettled() const;
  bool isSettled() const { return readoutIsSettled() && lensIsSettled(); }

 private:
  bool isDue(bool is_settled, bool rests, int keyframes) const;
  void lookAtReadout(const LookedAt& at, double longest_s, int keyframes, FoundCamera& found);
  void lookAtLens(const LookedAt& at, int keyframes, FoundCamera& found);

  CameraFindingOptions options_;
  ReadoutLooks readout_;
  LensLooks lens_;
  int since_readout_ = 0, since_lens_ = 0;  // was looked at [keyframes]
  int lens_waited_ = 0;                     // for the readout, in a row [keyframes]
  int looks_ = 0;
};

}  // namespace edgeslam
