// What counts of the looks at a camera: when what they say is more than chance, and when it has come to stay.
#pragma once

#include "mapping/camera_trial.h"
#include "mapping/lens_estimate.h"

namespace edgeslam {

// Of the readout: what the looks at it said, one after the other.
struct ReadoutLooks {
  int agreeing = 0;   // in a row, that say that it is not as presumed ...
  double last_s = 0;  // ... by how much it is to change, as the last of these said
  int steady = 0;     // keyframes over which they changed nothing
  bool was_found = false;
  bool is_settled = false;  // found, and it stayed; it is not looked for any more
  bool rests = false;       // it is as presumed, as far as the motion tells: another motion may tell more
};

// The same of the lens.
struct LensLooks {
  LensParts found;
  LensParts told;  // by the last look
  int steady = 0;
  bool is_settled = false;
  bool rests = false;
};

// True where the readout that there is now is to change, after one more look. `keyframes`: since the look before. It is
// settled when it stays for `enough` keyframes.
bool isToChange(const CameraEstimate& readout, double now_s, int keyframes, int enough, ReadoutLooks& looks);

// It is about to be found, or changed at the last look: what keyframes say of the lens is not theirs to say.
bool isUnderWay(const ReadoutLooks& looks);

// What of the lens the looks tell to be other than it is presumed, after one that tells of `parts` with so much
// evidence: they count if two looks in a row say so, or one beyond doubt.
LensParts toldByLooks(const LensParts& parts, double evidence, LensLooks& looks);

// True where the lens is to change by the estimate of what was told, from an adjustment that costs so much.
bool isToChange(const LensEstimate& estimate, const LensParts& told, double cost, int keyframes, int enough,
                LensLooks& looks);

// Of a cost, by what is to count of the lens.
double enoughGain(double cost);

}  // namespace edgeslam
