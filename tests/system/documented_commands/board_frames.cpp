// Frames of a chessboard that is shown to a camera, in TUM layout, as `edgeslam record` writes them.
// usage: board_frames BOARD FOLDER
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "unit/calibration/rendered_board.h"

namespace edgeslam {
namespace {

// Each view is there twice, 30 ms apart, as a camera has a board that is held still.
void writeFrames(const std::string& board_name, const std::string& folder) {
  const Camera camera{CameraModel::pinhole_radial_tangential, 320, 240, 290, 291, 161, 118, {0.03, -0.05, 0, 0, 0}};
  const Board board = parseBoard(board_name);
  const BoardRenderer renderer(board, camera);
  std::filesystem::create_directories(folder + "/rgb");
  std::ofstream list(folder + "/rgb.txt");
  std::uint64_t time_ms = 1000;
  for (const Hold& hold : goodHolds(camera)) {
    const cv::Mat grey = renderer.render(heldPose(board, camera, hold), {}, time_ms);
    for (const std::uint64_t shown_ms : {time_ms, time_ms + 30}) {
      char name[40];
      std::snprintf(name, sizeof(name), "%d.%03d", static_cast<int>(shown_ms / 1000),
                    static_cast<int>(shown_ms % 1000));
      cv::imwrite(folder + "/rgb/" + name + ".png", grey);
      list << name << " rgb/" << name << ".png\n";
    }
    time_ms += 140;
  }
}

}  // namespace
}  // namespace edgeslam

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  edgeslam::writeFrames(argv[1], argv[2]);
  return 0;
}
