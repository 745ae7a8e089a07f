// What the frames of a run saw, until it ends: on the disk, so that the memory that a run takes does not grow with it.
#pragma once

#include <cstddef>
#include <deque>
#include <string>

#include "files/scratch_file.h"
#include "tracking/seen_points.h"

namespace edgeslam {

class SeenRecord {
 public:
  // Of the next frame.
  void add(const SeenPoints& seen);
  // Of a frame, counted from 0; without points where it had none, or they could not be kept.
  SeenPoints of(std::size_t frame);
  // Why what frames see is not kept any more; empty: it is.
  const std::string& problem() const { return file_.problem(); }

 private:
  struct Kept {
    std::size_t offset = 0;  // in the file [byte]
    std::size_t points = 0;
    PointId first = 0;
    double pixel_step = 1;
  };

  static constexpr std::size_t most_bytes = std::size_t{1} << 30;  // some 130 000 frames of 500 points

  ScratchFile file_{most_bytes};
  std::deque<Kept> kept_;  // by frame
};

}  // namespace edgeslam
