// What counts of the looks at a camera: when what they say is more than chance, and when it has come to stay.
#pragma once

#include <Eigen/Core>

#include "mapping/camera_trial.h"
#include "mapping/lens_estimate.h"
#include "mapping/principal_point_estimate.h"

namespace edgeslam {

// How something is looked for. Values are readouts [s], logarithms of focal lengths, or distortions: by what share of
// their distance from the centre pixels are moved.
struct Looking {
  double least_sigma;   // none is known better
  double least;         // over so much and ...
  double least_sigmas;  // ... so many standard deviations, it is not as presumed
  int agreeing_looks;   // if so many say so, or one beyond doubt, within ...
  double agreement;     // ... this of each other
  double little;        // a change by less is none, for what has come to stay ...
  double too_little;    // ... and by less the map is not adjusted
  double well_known;    // standard deviation with which looks that find nothing count
};
inline constexpr Looking looking_for_readout{0.0005, 0, 3, 2, 0.05, 0.001, 0.0003, 0.002};
inline constexpr Looking looking_for_focal_length{0.005, 0.01, 2, 3, 0.02, 0.01, 0.003, 0.01};
inline constexpr Looking looking_for_distortion{0.0002, 0.004, 0, 3, 0.02, 0.001, 0.0003, 0.004};

// Of one thing that is looked for: what the looks at it said, one after the other.
struct CameraLooks {
  int agreeing = 0;  // in a row, that say that it is not as presumed ...
  double last = 0;   // ... and what the last of these said
  int steady = 0;    // keyframes over which they changed nothing
  bool was_found = false;
  bool is_settled = false;  // found, and it stayed; it is not looked for any more
  bool rests = false;       // it is as presumed, as far as the motion tells: another motion may tell more
};

// The same of the principal point.
struct PrincipalPointLooks {
  int agreeing = 0;
  Eigen::Vector2d last = Eigen::Vector2d::Zero();  // [px]
  int steady = 0;
  bool was_found = false;
  bool is_settled = false;
};

// True where the value that there is now is to change, after one more look. `keyframes`: since the look before. It is
// settled when it stays for `enough` keyframes. Looks at what `is_far_off` agree where they say to which side.
bool isToChange(const Looking& looking, const CameraEstimate& estimate, double now, int keyframes, int enough,
                CameraLooks& looks, bool is_far_off = false);

// The same of the principal point, before which the adjustment costs so much.
bool isToChange(const PrincipalPointEstimate& estimate, double cost, int keyframes, int enough,
                PrincipalPointLooks& looks);

// Of a cost, by what is to count of the lens, and of its principal point.
double enoughGain(double cost);
double enoughGainOfPrincipalPoint(double cost);

CameraEstimate focalLengthOf(const LensEstimate& estimate);
CameraEstimate distortionOf(const LensEstimate& estimate);  // root mean square over both radii

// What of the lens the trials tell to be other than it is presumed. What explains too little beside the other is as it
// was; where neither does, it is the one that explains more.
struct ToldOfLens {
  bool focal_length = false, distortion = false;
};
ToldOfLens toldOfLens(const LensEquations& equations, double cost);

}  // namespace edgeslam
