// What is wrong with a frame from a source, if anything.
#pragma once

#include <string>

#include "frames/frame_source.h"

namespace edgeslam {

// Empty where the frame can be used.
std::string frameProblem(const Frame& frame, const Camera& camera);

}  // namespace edgeslam
