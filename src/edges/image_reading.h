// How an image is read: which of its pixels are edges, and how exactly points on them are measured.
#pragma once

#include "edges/edge_pixels.h"
#include "edges/point_accuracy.h"

namespace edgeslam {

struct ImageReading {
  EdgeOptions edges;
  PointAccuracyOptions accuracy;
};

}  // namespace edgeslam
