// Whether every pixel of a camera is the image of one direction: distortion that is too strong folds the image.
#pragma once

#include "geometry/camera.h"

namespace edgeslam {

// Distance from the centre of the image's farthest corner, as it is seen: in focal lengths.
double farthestCorner(const Camera& camera);

// True where no pixel is the image of two directions, or of none. By the radial coefficients.
bool isOneToOne(const Camera& camera);

}  // namespace edgeslam
