// The pixel kernels beside their scalar references, OpenCV's equivalents and a copy of the bytes that they read and
// write, on one thread.
// usage: image_kernels_benchmark [IMAGE|VIDEO] [--benchmark_...]
// Of a video the frame in its middle is taken; without either, a made texture of 640 x 480.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "bench/ratio_reporter.h"
#include "bench/timed_work.h"
#include "edges/edge_detection.h"
#include "edges/edge_neighbours.h"
#include "edges/point_choice.h"
#include "edges/thinning.h"
#include "image/gradient_products.h"
#include "image/halving.h"
#include "image/pyramid.h"
#include "unit/edges/synthetic_image.h"

namespace edgeslam {
namespace {

constexpr int kLevels = 6;

void addPyramid(const cv::Mat& grey) {
  auto pyramid = std::make_shared<ImagePyramid>(buildPyramid(grey, kLevels));
  addTimed("pyramid/ours", [=] { buildPyramid(grey, kLevels, *pyramid); });
  addTimed("pyramid/reference", [=] {
    grey.copyTo(pyramid->levels[0]);
    for (size_t i = 1; i < pyramid->levels.size(); ++i) halveReference(pyramid->levels[i - 1], pyramid->levels[i]);
  });
  auto opencv = std::make_shared<std::vector<cv::Mat>>();
  addTimed("pyramid/buildOpticalFlowPyramid", [=] {
    cv::buildOpticalFlowPyramid(grey, *opencv, {pyramid_border, pyramid_border}, kLevels - 1,
                                /*withDerivatives=*/false);
  });
  addCopy("pyramid", grey.total() * 8 / 3);  // each level is read once and written once
}

void addDifferenceOfGaussians(const cv::Mat& grey) {
  const EdgeOptions options;
  auto images = std::make_shared<DifferenceOfGaussians>();
  addTimed("dog/ours", [=] { differenceOfGaussians(grey, options.sigma, options.sigma_ratio, *images); });
  addTimed("dog/reference", [=] { differenceOfGaussiansReference(grey, options.sigma, options.sigma_ratio, *images); });
  struct Blurs {
    cv::Mat scaled, narrow, wide, dog;
  };
  auto blurs = std::make_shared<Blurs>();
  addTimed("dog/GaussianBlur twice", [=] {
    const double further = options.sigma * std::sqrt(options.sigma_ratio * options.sigma_ratio - 1);
    grey.convertTo(blurs->scaled, CV_16U, blur_scale);
    cv::GaussianBlur(blurs->scaled, blurs->narrow, {11, 11}, options.sigma, options.sigma, cv::BORDER_REPLICATE);
    cv::GaussianBlur(blurs->narrow, blurs->wide, {9, 9}, further, further, cv::BORDER_REPLICATE);
    cv::subtract(blurs->narrow, blurs->wide, blurs->dog, cv::noArray(), CV_16S);
  });
  addCopy("dog", grey.total() * 5);  // reads 1 byte a pixel, writes 2 of each image
}

void addEdges(const cv::Mat& grey) {
  const EdgeOptions options;
  auto workspace = std::make_shared<EdgeWorkspace>();
  auto edges = std::make_shared<EdgeMap>();
  detectEdges(grey, options, *workspace, *edges);
  std::printf("%zu edge points in %d chains\n", edges->points.size(), edges->chain_count);

  auto blurs = std::make_shared<DifferenceOfGaussians>();
  differenceOfGaussians(grey, options.sigma, options.sigma_ratio, *blurs);
  auto pixels = std::make_shared<EdgePixels>();
  auto index = std::make_shared<cv::Mat>();
  addTimed("edge_pixels/ours", [=] { findEdgePixels(*blurs, options, *pixels, *index); });
  addTimed("edge_pixels/reference", [=] { findEdgePixelsReference(*blurs, options, *pixels, *index); });
  auto sobel = std::make_shared<std::array<cv::Mat, 2>>();
  addTimed("edge_pixels/Sobel, both ways", [=] {
    cv::Sobel(grey, (*sobel)[0], CV_16S, 1, 0);
    cv::Sobel(grey, (*sobel)[1], CV_16S, 0, 1);
  });

  addCopy("edge_pixels", grey.total() * 8);  // reads 2 bytes a pixel of each image, writes 4 of the index

  auto thinned = std::make_shared<EdgePixels>();
  auto named = std::make_shared<cv::Mat>();
  findEdgePixels(*blurs, options, *thinned, *named);
  const cv::Mat unthinned = named->clone();
  auto again = std::make_shared<cv::Mat>(unthinned.clone());
  addTimed("thinning with copy of index/ours", [=] {
    unthinned.copyTo(*again);
    thin(thinned->points, *again);
  });
  addCopy("thinning with copy of index", unthinned.total() * 8);
  thin(thinned->points, *named);
  auto links = std::make_shared<std::array<std::vector<int>, 2>>();
  links->fill(std::vector<int>(thinned->points.size()));
  addTimed("neighbours/ours", [=] { chooseNeighbours(thinned->points, *named, (*links)[0], (*links)[1]); });
  addTimed("neighbours/reference",
           [=] { chooseNeighboursReference(thinned->points, *named, (*links)[0], (*links)[1]); });

  const std::size_t touched = thinned->points.size() * (sizeof(EdgePixel) + 2 * sizeof(int) + 6 * 4 * sizeof(float));
  addCopy("neighbours", touched);  // each point, the six next to it, and what is chosen

  addTimed("edges/ours", [=] { detectEdges(grey, options, *workspace, *edges); });
  auto canny = std::make_shared<cv::Mat>();
  addTimed("edges/Canny", [=] { cv::Canny(grey, *canny, 50, 100); });
  addCopy("edges", grey.total() * 5 + edges->points.size() * sizeof(EdgePoint));  // reads 1 byte a pixel, writes 4
}

void addPoints(const cv::Mat& grey) {
  auto edges = std::make_shared<EdgeMap>(detectEdges(grey, {}));
  auto workspace = std::make_shared<PointChoiceWorkspace>();
  auto chosen = std::make_shared<std::vector<ChosenPoint>>();
  choosePoints(grey, *edges, {}, {}, {}, *workspace, *chosen);
  std::vector<cv::Rect> windows;
  for (const ChosenPoint& point : *chosen) {
    const cv::Rect window(static_cast<int>(point.pixel.x()) - 7, static_cast<int>(point.pixel.y()) - 7, 15, 15);
    windows.push_back(window & cv::Rect({0, 0}, grey.size()));
  }
  addTimed("tensors/ours", [=] {
    for (const cv::Rect& window : windows) benchmark::DoNotOptimize(gradientProducts(grey, window));
  });
  addTimed("tensors/reference", [=] {
    for (const cv::Rect& window : windows) benchmark::DoNotOptimize(gradientProductsReference(grey, window));
  });
  auto gradients = std::make_shared<cv::Mat>();
  addTimed("tensors/cornerEigenValsAndVecs, whole image", [=] { cv::cornerEigenValsAndVecs(grey, *gradients, 15, 3); });
  addCopy("tensors", windows.size() * (17 * 17 + sizeof(GradientProducts)));

  auto candidates = std::make_shared<std::vector<PointCandidate>>();
  auto spacing = std::make_shared<PointSpacing>(grey.size(), PointChoiceOptions().spacing);
  addTimed("candidates/ours", [=] {
    candidates->clear();
    findPointCandidates(grey, *edges, *spacing, {}, {}, *candidates);
  });
  addTimed("candidates/cornerMinEigenVal", [=] { cv::cornerMinEigenVal(grey, *gradients, 15, 3); });
  addTimed("points/ours", [=] { choosePoints(grey, *edges, {}, {}, {}, *workspace, *chosen); });
  auto corners = std::make_shared<std::vector<cv::Point2f>>();
  addTimed("points/goodFeaturesToTrack", [=] { cv::goodFeaturesToTrack(grey, *corners, 550, 0.01, 6); });
}

// Empty where the file is neither an image nor a video.
cv::Mat readFrame(const std::string& path) {
  cv::Mat frame = cv::imread(path, cv::IMREAD_GRAYSCALE);
  if (!frame.empty()) return frame;
  cv::VideoCapture video(path);
  const int middle = static_cast<int>(video.get(cv::CAP_PROP_FRAME_COUNT)) / 2;
  for (int i = 0; i <= middle && video.read(frame);) ++i;
  if (frame.channels() == 3) cv::cvtColor(frame, frame, cv::COLOR_BGR2GRAY);
  return frame;
}

}  // namespace
}  // namespace edgeslam

int main(int argument_count, char** arguments) {
  benchmark::Initialize(&argument_count, arguments);
  if (argument_count > 2) {
    std::fprintf(stderr, "usage: image_kernels_benchmark [IMAGE|VIDEO] [--benchmark_...]\n");
    return 2;
  }
  cv::setNumThreads(1);
  const cv::Mat grey = argument_count == 2 ? edgeslam::readFrame(arguments[1])
                                           : edgeslam::withNoise(edgeslam::renderTexture({640, 480}, 1), 2, 1);
  if (grey.empty() || grey.type() != CV_8U) {
    std::fprintf(stderr, "%s: neither an image nor a video that can be read\n", arguments[1]);
    return 2;
  }
  std::printf("%d x %d pixels, ", grey.cols, grey.rows);
  edgeslam::addPyramid(grey);
  edgeslam::addDifferenceOfGaussians(grey);
  edgeslam::addEdges(grey);
  edgeslam::addPoints(grey);
  edgeslam::RatioReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return 0;
}
