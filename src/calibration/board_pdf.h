// A board as a page to print: vectors at true scale, with a ruler that shows whether the printer kept it.
#pragma once

#include <string>

#include "calibration/board.h"

namespace edgeslam {

struct Paper {
  std::string name;
  double width_mm = 0, height_mm = 0;  // upright
};

// A0 to A5, letter, legal, tabloid (in any case), or WIDTHxHEIGHT in mm. Throws InputError that lists them.
Paper paperOfName(const std::string& name);

// The page as a PDF file's bytes, the paper turned as fits. It tells the board's own description, and a ruler of 100
// mm. Throws InputError where the board does not fit the paper, with what it takes and the squares that would fit.
std::string boardPdf(const Board& board, const Paper& paper);

}  // namespace edgeslam
