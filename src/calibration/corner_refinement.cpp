#include "calibration/corner_refinement.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

namespace edgeslam {
namespace {

constexpr int pattern_parameters = 7;       // shift x, y [px]; level, its slope along x, y; contrast; blur [px]
constexpr int largest_pattern_window = 13;  // half the side [px]
constexpr std::size_t fewest_pixels = 20;
constexpr double largest_shift_px = 1.5;
constexpr double least_contrast = 4;     // half the step from black to white [grey]
constexpr double largest_misfit = 0.35;  // deviation of the grey values from the pattern over the contrast

using ParameterVector = Eigen::Matrix<double, pattern_parameters, 1>;
using ParameterMatrix = Eigen::Matrix<double, pattern_parameters, pattern_parameters>;

// What may be looked at about a corner, in the board frame.
struct Surroundings {
  double reach_m = 0;              // along both axes
  double white_margin_m = 0;       // in white squares not farther than this from the nearer axis: a marker lies there
  bool white_is_positive = false;  // white where u * v > 0
};

Surroundings surroundingsOf(const Board& board, int number) {
  if (board.kind == BoardKind::aprilgrid) {
    const double reach = 0.85 * board.square_m * std::min(board.spacing, 0.2);
    return {reach, reach, number % 2 == 1};
  }
  const double reach = 0.45 * board.square_m;
  if (board.kind == BoardKind::chessboard) return {reach, reach, false};
  const int columns = board.columns - 1;
  const bool black_is_positive = (number % columns + number / columns) % 2 == 0;
  return {reach, 0.4 * (board.square_m - board.marker_m), !black_is_positive};
}

struct Sample {
  Eigen::Vector2d offset;   // from the corner's first position [px]
  Eigen::Vector2d place_m;  // on the board, from the corner
  double grey = 0;
};

Eigen::Vector2d placeOnBoard(const Camera& camera, const Pose& board_T_camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector3d direction = board_T_camera.rotation * bearing(camera, pixel);
  const double distance = -board_T_camera.translation.z() / direction.z();
  return (board_T_camera.translation + distance * direction).head<2>();
}

std::vector<Sample> samplesAbout(const cv::Mat& grey, const Surroundings& surroundings, const Camera& camera,
                                 const Pose& board_T_camera, const MeasuredCorner& corner, double pixel_m) {
  std::vector<Sample> samples;
  const int half =
      std::clamp(static_cast<int>(std::ceil(1.5 * surroundings.reach_m / pixel_m)), 2, largest_pattern_window);
  const int x0 = static_cast<int>(std::lround(corner.pixel.x())), y0 = static_cast<int>(std::lround(corner.pixel.y()));
  for (int y = std::max(0, y0 - half); y <= std::min(grey.rows - 1, y0 + half); ++y) {
    for (int x = std::max(0, x0 - half); x <= std::min(grey.cols - 1, x0 + half); ++x) {
      const Eigen::Vector2d pixel(x, y);
      const Eigen::Vector2d place = placeOnBoard(camera, board_T_camera, pixel) - corner.place_m;
      if (!(place.lpNorm<Eigen::Infinity>() <= surroundings.reach_m)) continue;
      const bool is_white = (place.x() * place.y() > 0) == surroundings.white_is_positive;
      if (is_white && place.cwiseAbs().minCoeff() > surroundings.white_margin_m) continue;
      samples.push_back({pixel - corner.pixel, place, static_cast<double>(grey.at<unsigned char>(y, x))});
    }
  }
  return samples;
}

// The pattern's value at a sample and its derivative. `board_by_pixel`: derivative of the place on the board by the
// pixel, at the corner.
double pattern(const Sample& sample, const Eigen::Matrix2d& board_by_pixel, const ParameterVector& p,
               ParameterVector& derivative) {
  const Eigen::Vector2d place = sample.place_m - board_by_pixel * p.head<2>();
  const double across_u = board_by_pixel.row(0).norm(), across_v = board_by_pixel.row(1).norm();
  const double u = place.x() / (p(6) * across_u), v = place.y() / (p(6) * across_v);  // in deviations of the blur
  const double fu = std::erf(u * M_SQRT1_2), fv = std::erf(v * M_SQRT1_2);
  const double slope = std::sqrt(2 / M_PI);
  const double du = slope * std::exp(-0.5 * u * u) * fv, dv = slope * std::exp(-0.5 * v * v) * fu;
  const Eigen::RowVector2d by_shift =
      -(du / (p(6) * across_u)) * board_by_pixel.row(0) - (dv / (p(6) * across_v)) * board_by_pixel.row(1);
  derivative << p(5) * by_shift.transpose(), 1, sample.offset.x(), sample.offset.y(), fu * fv,
      -p(5) * (du * u + dv * v) / p(6);
  return p(2) + p(3) * sample.offset.x() + p(4) * sample.offset.y() + p(5) * fu * fv;
}

// Level and contrast that suit the pattern where it is.
ParameterVector startingParameters(const std::vector<Sample>& samples, const Eigen::Matrix2d& board_by_pixel) {
  ParameterVector p;
  p << 0, 0, 0, 0, 0, 1, 0.8;
  double sum = 0, sum_f = 0, sum_ff = 0, sum_fg = 0;
  for (const Sample& sample : samples) {
    ParameterVector derivative;
    pattern(sample, board_by_pixel, p, derivative);
    sum += sample.grey;
    sum_f += derivative(5);
    sum_ff += derivative(5) * derivative(5);
    sum_fg += derivative(5) * sample.grey;
  }
  const double n = static_cast<double>(samples.size());
  p(5) = (sum_fg - sum_f * sum / n) / std::max(sum_ff - sum_f * sum_f / n, 1e-9);
  p(2) = (sum - p(5) * sum_f) / n;
  return p;
}

}  // namespace

std::optional<RefinedCorner> refineCorner(const cv::Mat& grey, const Board& board, const Camera& camera,
                                          const Pose& camera_T_board, const MeasuredCorner& corner) {
  const Pose board_T_camera = camera_T_board.inverse();
  Eigen::Matrix2d board_by_pixel;
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector2d step = 0.5 * Eigen::Vector2d::Unit(i);
    board_by_pixel.col(i) = placeOnBoard(camera, board_T_camera, corner.pixel + step) -
                            placeOnBoard(camera, board_T_camera, corner.pixel - step);
  }
  const double pixel_m = std::sqrt(std::abs(board_by_pixel.determinant()));
  if (!board_by_pixel.allFinite() || !(pixel_m > 0)) return std::nullopt;
  // The pattern stands where camera and pose say the corner's pixel is, not where they say the corner is.
  MeasuredCorner seen = corner;
  seen.place_m = placeOnBoard(camera, board_T_camera, corner.pixel);
  const std::vector<Sample> samples =
      samplesAbout(grey, surroundingsOf(board, corner.number), camera, board_T_camera, seen, pixel_m);
  if (samples.size() < fewest_pixels) return std::nullopt;

  ParameterVector p = startingParameters(samples, board_by_pixel);
  ParameterMatrix information;
  double misfit = 0;
  for (int iteration = 0; iteration < 12; ++iteration) {
    information.setZero();
    ParameterVector gradient = ParameterVector::Zero();
    misfit = 0;
    for (const Sample& sample : samples) {
      ParameterVector derivative;
      const double error = sample.grey - pattern(sample, board_by_pixel, p, derivative);
      information.noalias() += derivative * derivative.transpose();
      gradient.noalias() += error * derivative;
      misfit += error * error;
    }
    ParameterMatrix held = information;
    held.diagonal() *= 1 + 1e-6;
    ParameterVector step = held.ldlt().solve(gradient);
    if (!step.allFinite()) return std::nullopt;
    const double longest = std::max(step.head<2>().norm() / 0.5, std::abs(step(6)) / 0.3);
    if (longest > 1) step /= longest;
    p += step;
    p(6) = std::clamp(p(6), 0.3, 6.0);
    if (!(p.head<2>().norm() < largest_shift_px)) return std::nullopt;
    if (step.head<2>().norm() < 1e-4 && iteration > 1) break;
  }
  const double variance = misfit / static_cast<double>(samples.size() - pattern_parameters);
  if (!(std::abs(p(5)) > least_contrast) || !(std::sqrt(variance) < largest_misfit * std::abs(p(5))))
    return std::nullopt;
  const ParameterMatrix covariance = variance * information.inverse();
  if (!covariance.allFinite()) return std::nullopt;
  return RefinedCorner{corner.pixel + p.head<2>(), covariance.topLeftCorner<2, 2>()};
}

}  // namespace edgeslam
