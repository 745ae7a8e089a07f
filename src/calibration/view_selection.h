// Which frames become views of a calibration: the board is found and sharp, it stands still, and it is seen otherwise
// than in the views taken before.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "calibration/board_detection.h"
#include "geometry/camera.h"

namespace edgeslam {

// How a board is seen: what makes views differ.
struct ViewLook {
  Eigen::Vector2d centre;    // of the board's corners, over the image's width and height
  double size = 0;           // side of a square over the image's longer side
  Eigen::Vector2d tilt_rad;  // of the board's normal: x turned to the right, y turned down; 0 when it is frontal
  double roll_rad = 0;       // about the camera's axis
  double filled = 0;         // share of the image that the corners' hull takes
};

struct BoardView {
  std::int64_t frame = 0;  // in its source
  std::int64_t time_ns = 0;
  cv::Mat grey;  // CV_8U
  BoardSighting sighting;
  ViewLook look;
};

struct SelectionOptions {
  double largest_blur_px = 2.2;        // of the edges, as a Gaussian's deviation
  double largest_blur_squares = 0.15;  // likewise, over a square's side
  double largest_motion_px = 1.5;      // of the corners from a frame to the next, where that comes soon after
  double soon_s = 0.2;                 // frames farther apart are stills: each stands for itself
  double least_interval_s = 0.1;       // between frames that are looked at
  std::size_t most_views = 100;
};

enum class ViewDecision { taken, waiting, no_board, blurred, moving, not_new, not_looked_at };

struct SelectionCounts {
  std::int64_t frames = 0, looked_at = 0, no_board = 0, blurred = 0, moving = 0, not_new = 0;
};

class ViewSelection {
 public:
  ViewSelection(const Board& board, const SelectionOptions& options) : board_(board), options_(options) {}

  // Frames in the order of their times. A frame that is followed soon by another waits for that one to see whether the
  // board stands still. Throws InputError where its size is not that of the frames before.
  ViewDecision add(std::int64_t frame, std::int64_t time_ns, const cv::Mat& grey);
  // After the last frame: takes the one that still waits.
  void end();

  const std::vector<BoardView>& views() const { return views_; }
  const SelectionCounts& counts() const { return counts_; }
  cv::Size imageSize() const { return size_; }
  const cv::Mat& lastWithoutBoard() const { return last_without_board_; }  // empty where the board was always found

 private:
  bool isNew(const ViewLook& look) const;
  ViewDecision take(BoardView view);

  Board board_;
  SelectionOptions options_;
  cv::Size size_;
  std::vector<BoardView> views_, waiting_;  // waiting: none or one
  SelectionCounts counts_;
  std::int64_t last_looked_ns_ = 0;
  cv::Mat last_without_board_;
};

// `focal_px`: nearly, for the tilt.
ViewLook lookOf(const BoardSighting& sighting, const Board& board, cv::Size size, double focal_px);

}  // namespace edgeslam
