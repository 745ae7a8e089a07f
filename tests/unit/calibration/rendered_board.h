// Images of a board as a known camera sees it: exact, but for noise and blur that are asked for.
#pragma once

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "calibration/board_drawing.h"
#include "calibration/view_selection.h"
#include "geometry/camera.h"
#include "geometry/pose.h"

namespace edgeslam {

// Black or white at each place of a board; its rectangles' sides cut the plane into cells.
class BoardPaint {
 public:
  explicit BoardPaint(const Board& board) : drawing_(drawBoard(board)) {
    for (const BoardRectangle& r : drawing_.black) {
      xs_.insert(xs_.end(), {r.left_m, r.right_m});
      ys_.insert(ys_.end(), {r.top_m, r.bottom_m});
    }
    sortUnique(xs_);
    sortUnique(ys_);
    cells_ = cv::Mat(static_cast<int>(ys_.size()), static_cast<int>(xs_.size()), CV_8U, cv::Scalar(0));
    for (const BoardRectangle& r : drawing_.black) {
      cells_(cv::Range(cell(ys_, middle(r.top_m)), cell(ys_, middle(r.bottom_m))),
             cv::Range(cell(xs_, middle(r.left_m)), cell(xs_, middle(r.right_m)))) = 1;
    }
  }

  const BoardRectangle& extent() const { return drawing_.extent; }

  // Grey of the board with a white rim as wide as `rim_m`, -1 beside it.
  double grey(double x, double y, double rim_m) const {
    const BoardRectangle& e = drawing_.extent;
    if (x < e.left_m - rim_m || y < e.top_m - rim_m || x > e.right_m + rim_m || y > e.bottom_m + rim_m) return -1;
    const int column = cell(xs_, x), row = cell(ys_, y);
    const bool inside = column >= 0 && row >= 0 && column < cells_.cols - 1 && row < cells_.rows - 1;
    return inside && cells_.at<unsigned char>(row, column) != 0 ? 40 : 210;
  }

 private:
  static constexpr double same_m = 1e-9;
  static void sortUnique(std::vector<double>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end(), [](double a, double b) { return b - a < same_m; }),
                 values.end());
  }
  // A side that was rounded otherwise still begins its cell.
  static double middle(double side) { return side + same_m; }
  static int cell(const std::vector<double>& sides, double value) {
    return static_cast<int>(std::upper_bound(sides.begin(), sides.end(), value) - sides.begin()) - 1;
  }

  BoardDrawing drawing_;
  std::vector<double> xs_, ys_;
  cv::Mat cells_;
};

struct RenderOptions {
  double blur_px = 0.6;  // Gaussian, besides the pixel's own square
  double noise = 1.5;    // standard deviation [grey]
  Eigen::Vector2d motion_px = Eigen::Vector2d::Zero();
};

class BoardRenderer {
 public:
  BoardRenderer(const Board& board, const Camera& camera) : paint_(board), camera_(camera) {
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        for (int s = 0; s < kSide * kSide; ++s) {
          const Eigen::Vector2d pixel(x + (s % kSide + 0.5) / kSide - 0.5, y + (s / kSide + 0.5) / kSide - 0.5);
          rays_.push_back(bearing(camera, pixel).cast<float>());
        }
      }
    }
  }

  cv::Mat render(const Pose& camera_T_board, const RenderOptions& options, std::uint64_t seed) const {
    const Pose board_T_camera = camera_T_board.inverse();
    const Eigen::Matrix3d rotation = board_T_camera.rotation.toRotationMatrix();
    const Eigen::Vector3d& from = board_T_camera.translation;
    const double rim_m = 0.06 * (paint_.extent().right_m - paint_.extent().left_m);
    cv::Mat image(camera_.height, camera_.width, CV_32F);
    std::size_t ray = 0;
    for (int y = 0; y < camera_.height; ++y) {
      for (int x = 0; x < camera_.width; ++x) {
        double sum = 0;
        for (int s = 0; s < kSide * kSide; ++s) {
          const Eigen::Vector3d direction = rotation * rays_[ray++].cast<double>();
          const double distance = -from.z() / direction.z();
          double grey = -1;
          if (distance > 0) {
            grey = paint_.grey(from.x() + distance * direction.x(), from.y() + distance * direction.y(), rim_m);
          }
          sum += grey < 0 ? 90 : grey;
        }
        // Lit from the left.
        image.at<float>(y, x) = static_cast<float>(sum / (kSide * kSide) * (1 - 0.2 * x / camera_.width));
      }
    }
    return sensed(image, options, seed);
  }

 private:
  static constexpr int kSide = 3;  // samples along a pixel's sides

  static cv::Mat sensed(cv::Mat image, const RenderOptions& options, std::uint64_t seed) {
    if (options.blur_px > 0) cv::GaussianBlur(image, image, {0, 0}, options.blur_px);
    const double length = options.motion_px.norm();
    if (length > 0) {
      const int half = static_cast<int>(std::ceil(length / 2));
      cv::Mat kernel(2 * half + 1, 2 * half + 1, CV_32F, cv::Scalar(0));
      for (int i = -50; i <= 50; ++i) {
        const Eigen::Vector2d at = options.motion_px * (i / 100.0);
        kernel.at<float>(half + static_cast<int>(std::lround(at.y())), half + static_cast<int>(std::lround(at.x()))) +=
            1;
      }
      cv::filter2D(image, image, -1, kernel / cv::sum(kernel)[0]);
    }
    cv::Mat noise(image.size(), CV_32F), grey;
    cv::RNG random(seed);
    random.fill(noise, cv::RNG::NORMAL, 0, options.noise);
    cv::Mat(image + noise).convertTo(grey, CV_8U);
    return grey;
  }

  BoardPaint paint_;
  Camera camera_;
  std::vector<Eigen::Vector3f> rays_;
};

// How a board is held before the camera.
struct Hold {
  double x = 0.5, y = 0.5;        // where its middle is seen, over the image's width and height
  double width = 0.5;             // of the board over the image's, if it were frontal and in the middle
  double turned = 0, nodded = 0;  // about the vertical and the horizontal axis [rad]
  double roll = 0;                // [rad]
};

inline Pose heldPose(const Board& board, const Camera& camera, const Hold& hold) {
  const BoardRectangle extent = BoardPaint(board).extent();
  const double distance = camera.fx * (extent.right_m - extent.left_m) / (hold.width * camera.width);
  Pose pose;
  pose.rotation = Eigen::AngleAxisd(hold.turned, Eigen::Vector3d::UnitY()) *
                  Eigen::AngleAxisd(hold.nodded, Eigen::Vector3d::UnitX()) *
                  Eigen::AngleAxisd(hold.roll, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d middle((extent.left_m + extent.right_m) / 2, (extent.top_m + extent.bottom_m) / 2, 0);
  const Eigen::Vector3d direction = bearing(camera, {hold.x * (camera.width - 1), hold.y * (camera.height - 1)});
  pose.translation = direction * distance - pose.rotation * middle;
  return pose;
}

// A good set: over the image, tilted every way, near and far.
inline std::vector<Hold> goodHolds(const Camera& camera) {
  std::vector<Hold> holds;
  constexpr double tilt = 0.55;
  for (int i = 0; i < 24; ++i) {
    Hold hold;
    const int place = i % 8 + (i % 8 >= 4 ? 1 : 0);  // the middle comes with the near ones
    hold.width = 0.42 + 0.04 * (i % 3);
    hold.x = 0.5 + 0.24 * (place % 3 - 1);
    hold.y = 0.5 + 0.2 * (place / 3 - 1);
    const int way = (i + i / 8) % 5;
    hold.turned = way == 0 ? tilt : way == 1 ? -tilt : 0.08 * (i % 3 - 1);
    hold.nodded = way == 2 ? tilt : way == 3 ? -tilt : 0.08 * (i % 2);
    hold.roll = 0.25 * (i % 4) - 0.3;
    if (i % 6 == 5) {  // near, in the middle
      hold.x = 0.48 + 0.01 * (i % 5);
      hold.y = 0.52 - 0.01 * (i % 3);
      hold.width = 0.72;
    }
    if (camera.model == CameraModel::kannala_brandt) hold.width *= 1.3;
    holds.push_back(hold);
  }
  return holds;
}

// Numbers of a chessboard's corners run from either end: here from the one near `first`.
inline std::vector<BoardCorner> numberedFrom(std::vector<BoardCorner> corners, const Board& board,
                                             const Eigen::Vector2d& first) {
  const std::size_t count = boardCorners(board).size();
  const bool reversed = board.kind == BoardKind::chessboard && corners.size() == count &&
                        (corners.back().pixel - first).norm() < (corners.front().pixel - first).norm();
  for (std::size_t i = 0; reversed && i < count; ++i) corners[i].number = static_cast<int>(count - 1 - i);
  return corners;
}

// Views of the frames in their order, half a second apart.
inline ViewSelection selectedFrom(const Board& board, const std::vector<cv::Mat>& frames) {
  ViewSelection selection(board, {});
  std::int64_t time_ns = 0, index = 0;
  for (const cv::Mat& frame : frames) selection.add(index++, time_ns += 500'000'000, frame);
  selection.end();
  return selection;
}

inline std::vector<cv::Mat> renderedFrames(const Board& board, const Camera& camera, const std::vector<Hold>& holds,
                                           const RenderOptions& options = {}) {
  const BoardRenderer renderer(board, camera);
  std::vector<cv::Mat> frames;
  for (const Hold& hold : holds) {
    frames.push_back(renderer.render(heldPose(board, camera, hold), options, frames.size() + 1));
  }
  return frames;
}

// Root mean square and maximum over the image of the distance [px] between the pixels of a bearing in both cameras.
struct CameraDifference {
  double rms_px = 0, max_px = 0;
};
inline CameraDifference cameraDifference(const Camera& truth, const Camera& estimate) {
  CameraDifference difference;
  double sum = 0;
  constexpr int steps = 24;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps; ++j) {
      const Eigen::Vector2d pixel(i * (truth.width - 1.0) / steps, j * (truth.height - 1.0) / steps);
      const double distance = (project(estimate, bearing(truth, pixel)) - pixel).norm();
      sum += distance * distance;
      difference.max_px = std::max(difference.max_px, distance);
    }
  }
  difference.rms_px = std::sqrt(sum / ((steps + 1) * (steps + 1)));
  return difference;
}

}  // namespace edgeslam
