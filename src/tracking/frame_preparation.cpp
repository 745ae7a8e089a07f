#include "tracking/frame_preparation.h"

#include <utility>

namespace edgeslam {
namespace {

constexpr int images_at_start = 8;
constexpr int edge_maps = 5;  // the current, the last, the lost and the kept frame's, and one that mapping looks at

}  // namespace

cv::Mat imageOfASquare(const Camera& camera) {
  cv::Mat square(camera.height, camera.width, CV_8U, cv::Scalar(0));
  square(cv::Rect(square.cols / 4, square.rows / 4, square.cols / 2, square.rows / 2)).setTo(255);
  return square;
}

FramePreparation::FramePreparation(const Camera& camera, const PreparationOptions& options)
    : options_(options),
      mask_(camera.mask),
      image_pool_([size = cv::Size(camera.width, camera.height), levels = options.pyramid_levels](FrameImages& images) {
        buildPyramid(cv::Mat(size, CV_8U, cv::Scalar(0)), levels, images.pyramid);
      }),
      edge_pool_([size = cv::Size(camera.width, camera.height)](EdgeMap& edges) { edges = makeEdgeMap(size); }),
      accuracy_{options.accuracy} {
  image_pool_.keepReady(images_at_start);
  edge_pool_.keepReady(edge_maps);
  EdgeMap edges = makeEdgeMap({camera.width, camera.height});
  detectEdges(imageOfASquare(camera), options_.edges, workspace_, edges);
}

bool FramePreparation::prepare(std::int64_t frame_index, std::int64_t time_ns, const cv::Mat& grey,
                               FollowedFrame& frame, StageClock& clock) {
  std::shared_ptr<FrameImages> images = image_pool_.take();
  images->frame_index = frame_index;
  images->time_ns = time_ns;
  buildPyramid(grey, options_.pyramid_levels, images->pyramid);
  clock.finished(Stage::pyramid);
  if (!frame.edges || frame.edges.use_count() > 1) frame.edges = edge_pool_.take();
  detectEdges(images->pyramid.levels[0], options_.edges, workspace_, *frame.edges, mask_.get());
  const double noise_factor = accuracy_.noise_factor;
  accuracy_ = accuracyIn(images->pyramid.levels[0], options_.accuracy, mask_.get());
  accuracy_.noise_factor = noise_factor;
  clock.finished(Stage::edges);
  frame.tracks.clear();
  frame.straight_edges.clear();
  frame.covariance.setZero();
  frame.inlier_count = 0;
  frame.outlier_share = 0;
  frame.noise = NoiseEvidence();
  frame.images = latest_images_ = std::move(images);
  return !isBlurred(blur_gate_, {time_ns, sharpness(grey, *frame.edges)}, options_.blur_gate);
}

}  // namespace edgeslam
