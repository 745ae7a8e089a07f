#include "tracking/stage_times.h"

namespace edgeslam {

const char* stageName(Stage stage) {
  switch (stage) {
    case Stage::pyramid:
      return "pyramid";
    case Stage::edges:
      return "edges";
    case Stage::alignment:
      return "alignment";
    case Stage::flow:
      return "flow";
    case Stage::pose:
      return "pose";
    case Stage::refinement:
      return "refinement";
    case Stage::map_reuse:
      return "map reuse";
    case Stage::choice_of_points:
      return "choice of points";
    case Stage::mapping:
      return "mapping";
    case Stage::places:
      return "places";
  }
  return "";
}

double StageTimes::total() const {
  double sum = 0;
  for (const Stage stage : all_stages) sum += (*this)[stage];
  return sum;
}

}  // namespace edgeslam
