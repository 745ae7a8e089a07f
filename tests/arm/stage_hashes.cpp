// Runs the stages up to the flow over pictures that are made in integers, and prints a hash of all that each of them
// gives: `SET STAGE PICTURE HASH`. Built for two processors, it prints the same lines where they give the same bits.
// SET is `integer`; `float` where there is floating point on the way; `libm` where there are functions of the C
// library, too.
#include <hwy/highway.h>

#include <cstdint>
#include <cstdio>
#include <vector>

#include "edges/edge_detection.h"
#include "edges/point_choice.h"
#include "flow/optical_flow.h"
#include "flow/warped_window.h"
#include "geometry/undistortion.h"
#include "image/pyramid.h"
#include "unit/image/every_target.h"

namespace edgeslam {
namespace {

constexpr int width = 320, height = 240, pictures = 6, levels = 4;

// FNV-1a.
class Hash {
 public:
  template <typename Value>
  void add(const Value& value) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(&value);
    for (std::size_t i = 0; i < sizeof(value); ++i) value_ = (value_ ^ bytes[i]) * 0x100000001b3U;
  }
  void add(const cv::Mat& image) {
    for (int y = 0; y < image.rows; ++y) {
      const unsigned char* row = image.ptr(y);
      for (std::size_t i = 0; i < static_cast<std::size_t>(image.cols) * image.elemSize(); ++i) add(row[i]);
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

void print(const char* set, const char* stage, int picture, const Hash& hash) {
  std::printf("%s %s %d %016llx\n", set, stage, picture, static_cast<unsigned long long>(hash.value()));
}

// Bare panels in zig-zag with discs before them; x, y in quarters of a pixel.
int greyOfScene(int x, int y) {
  static constexpr int discs[][4] = {
      {260, 300, 120, 35}, {900, 640, 170, 215}, {640, 180, 90, 150}, {1100, 250, 140, 70}};
  for (const auto& [disc_x, disc_y, radius, grey] : discs) {
    if ((x - disc_x) * (x - disc_x) + (y - disc_y) * (y - disc_y) < radius * radius) return grey;
  }
  const int folded = (y + 4000) % 480;
  const int band = (x + 4000 + (folded < 240 ? folded : 480 - folded)) / 230;
  return 60 + 45 * (band * 7 % 4);
}

// What is seen moves by a quarter of a pixel and more from picture to picture, and shears; some noise.
cv::Mat makePicture(int number) {
  cv::Mat picture(height, width, CV_8U);
  std::uint32_t random = 1 + static_cast<std::uint32_t>(number);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      int sum = 0;
      for (int part = 0; part < 16; ++part) {
        const int at_x = 4 * x + part % 4 + 9 * number + number * y / 80;
        const int at_y = 4 * y + part / 4 - 5 * number;
        sum += greyOfScene(at_x, at_y);
      }
      random = random * 1664525U + 1013904223U;
      picture.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(sum / 16 + static_cast<int>(random >> 29U) - 4);
    }
  }
  return picture;
}

struct Frame {
  cv::Mat picture;
  ImagePyramid pyramid;
  EdgeWorkspace workspace;
  EdgeMap edges;
  std::vector<ChosenPoint> points;
};

void printImages(const Frame& frame, int number) {
  Hash picture, pyramid, blurs;
  picture.add(frame.picture);
  for (const cv::Mat& level : frame.pyramid.levels) pyramid.add(level);
  blurs.add(frame.workspace.blurs.narrow);
  blurs.add(frame.workspace.blurs.dog);
  print("integer", "picture", number, picture);
  print("integer", "pyramid", number, pyramid);
  print("integer", "difference_of_gaussians", number, blurs);
}

void printEdges(const Frame& frame, int number) {
  Hash candidates, index, edges, products, tensors, points;
  for (const EdgePixel& point : frame.workspace.pixels.points) candidates.add(point.cell);
  index.add(frame.edges.index);
  for (const EdgePoint& point : frame.edges.points) {
    edges.add(point);
    const GradientProducts around = gradientProductsAround(frame.picture, point.pixel, 15);
    for (const std::int64_t sum : {around.xx, around.xy, around.yy}) products.add(sum);
    tensors.add(structureTensor(around));
  }
  for (const ChosenPoint& point : frame.points) {
    points.add(point.pixel);
    points.add(point.normal);
    points.add(point.tensor);
    points.add(point.sigma_normal);
    points.add(point.sigma_tangent);
  }
  print("integer", "edge_pixels", number, candidates);
  print("integer", "edge_chains", number, index);
  print("integer", "gradient_products", number, products);
  print("float", "edges", number, edges);
  print("float", "structure_tensors", number, tensors);
  print("float", "points", number, points);
}

void printPatches(const Frame& frame, int number) {
  Hash samples, templates, warped;
  for (const ChosenPoint& point : frame.points) {
    PatchTemplate patch;
    if (!makeTemplate(frame.picture, point.pixel, Eigen::Matrix2f::Identity(), 15, patch)) continue;
    samples.add(patch.samples.grey);
    samples.add(patch.samples.gradient_x);
    samples.add(patch.samples.gradient_y);
    templates.add(patch.normal_matrix);
    templates.add(patch.tensor);
    const auto x = static_cast<std::int32_t>(point.pixel.x()), y = static_cast<std::int32_t>(point.pixel.y());
    SampledWindow window{};
    sampleWarpedWindow(frame.picture.data, static_cast<std::ptrdiff_t>(frame.picture.step),
                       {x * 65536 + 1234, y * 65536 + 4321, 60000, 9000, -8000, 61000}, 7, window);
    for (int row = 0; row < 9; ++row) {
      for (int column = 0; column < 9; ++column)
        warped.add(window[static_cast<std::size_t>(row * window_row + column)]);
    }
  }
  print("integer", "patch_samples", number, samples);
  print("integer", "warped_windows", number, warped);
  print("float", "patch_templates", number, templates);
}

void printFlow(const Frame& from, const Frame& to, int number) {
  Hash flow;
  for (const ChosenPoint& point : from.points) {
    const FlowMatch match = followPoint(from.pyramid, to.pyramid, point.pixel, point.pixel, FlowOptions());
    flow.add(match.found);
    if (!match.found) continue;
    flow.add(match.pixel);
    flow.add(match.correlation);
    flow.add(backwardError(from.pyramid, to.pyramid, point.pixel, match.pixel, point.normal, FlowOptions()));
  }
  print("float", "flow", number, flow);
}

void printBearings(const char* set, CameraModel model, const std::array<double, 5>& distortion, int number) {
  const Camera camera{model, width, height, 260, 261, 158.5, 121.25, distortion};
  std::vector<Eigen::Vector2d> pixels;
  for (int i = 0; i < 1000; ++i) pixels.emplace_back(i * 37 % width + i * 0.001, i * 53 % height + i * 0.0007);
  std::vector<Eigen::Vector3d> bearings(pixels.size());
  bearingsOf(camera, pixels.data(), pixels.size(), bearings.data());
  Hash found, projected;
  for (const Eigen::Vector3d& bearing : bearings) {
    found.add(bearing);
    projected.add(project(camera, bearing));
  }
  print(set, "bearings", number, found);
  print(set, "projections", number, projected);
}

Frame process(int number) {
  Frame frame;
  frame.picture = makePicture(number);
  frame.pyramid = buildPyramid(frame.picture, levels);
  frame.edges = makeEdgeMap(frame.picture.size());
  detectEdges(frame.picture, EdgeOptions(), frame.workspace, frame.edges);
  frame.points = choosePoints(frame.picture, frame.edges, {}, PointChoiceOptions());
  return frame;
}

int run() {
  std::fprintf(stderr, "kernels:");
  for (std::int64_t left = everyTarget(); left != 0; left &= left - 1)
    std::fprintf(stderr, " %s", hwy::TargetName(left & -left));
  std::fprintf(stderr, "\n");
  Frame before;
  for (int number = 0; number < pictures; ++number) {
    Frame frame = process(number);
    printImages(frame, number);
    printEdges(frame, number);
    printPatches(frame, number);
    if (number > 0) printFlow(before, frame, number);
    if (frame.points.size() < 100) {
      std::fprintf(stderr, "picture %d: expected at least 100 points, got %zu\n", number, frame.points.size());
      return 1;
    }
    before = std::move(frame);
  }
  printBearings("float", CameraModel::pinhole_radial_tangential, {-0.28, 0.07, 0.0002, 0.00002, 0}, 0);
  printBearings("libm", CameraModel::kannala_brandt, {-0.01, 0.02, -0.003, 0.001, 0}, 1);
  return 0;
}

}  // namespace
}  // namespace edgeslam

int main() { return edgeslam::run(); }
