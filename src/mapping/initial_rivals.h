// P14: a structure held against rivals. One of lines can stand wrong and look well: before it is believed, others from
// quite different starts must fit the same measurements worse. Most of them fall into the same solution where that is
// the right one, or into wrong ones, and a part of the points tells these from others.
#pragma once

#include "mapping/initial_structure.h"

namespace edgeslam {

// The one of least error. A rival is adjusted with all points where, with a part of them, it fits about as well as the
// best one does, and differs from what was adjusted already. The same input gives the same output.
InitialStructure bestOfRivals(const Camera& camera, const InitialFrames& frames, InitialStructure structure,
                              const InitialisationOptions& options);

}  // namespace edgeslam
