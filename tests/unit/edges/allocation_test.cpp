// From the image to its pyramid, edges and points nothing is allocated once the memory was used for an image of that
// size: every allocation of this program goes through the functions below, which count those of the calling thread.
#include <gtest/gtest.h>

#include <cerrno>
#include <cstdlib>
#include <functional>
#include <new>

#include "edges/blur_gate.h"
#include "edges/edge_detection.h"
#include "edges/point_choice.h"
#include "image/pyramid.h"
#include "unit/edges/synthetic_image.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define EDGESLAM_COUNTS_ALLOCATIONS 0  // the sanitizers have their own allocator
#else
#define EDGESLAM_COUNTS_ALLOCATIONS 1
#endif

namespace {
thread_local int allocations = 0;
}

#if EDGESLAM_COUNTS_ALLOCATIONS
extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* memory, size_t size);
void* __libc_memalign(size_t alignment, size_t size);

void* malloc(size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, size_t size) {
  ++allocations;
  return __libc_realloc(memory, size);
}
void* memalign(size_t alignment, size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(size_t alignment, size_t size) { return memalign(alignment, size); }
int posix_memalign(void** memory, size_t alignment, size_t size) {
  *memory = memalign(alignment, size);
  return *memory ? 0 : ENOMEM;
}
}
#endif

namespace edgeslam {
namespace {

const cv::Size varied_image_size(333, 241);

// Of all kinds, an ordinary one first.
std::vector<cv::Mat> variedImages() {
  std::vector<cv::Mat> images = {withNoise(renderTexture(varied_image_size, 1), 1, 1),
                                 cv::Mat(varied_image_size, CV_8U, cv::Scalar(0)),
                                 cv::Mat(varied_image_size, CV_8U, cv::Scalar(255)),
                                 withNoise(cv::Mat(varied_image_size, CV_8U, cv::Scalar(128)), 60, 2),
                                 withNoise(cv::Mat(varied_image_size, CV_8U, cv::Scalar(128)), 1e4, 3)};
  for (const int side : {1, 2, 3, 4, 6, 9, 40}) images.push_back(renderCheckerboard(varied_image_size, side));
  for (const int period : {2, 4, 5, 6, 8}) {  // stripes: more edges than there is room for
    cv::Mat stripes(varied_image_size, CV_8U);
    for (int x = 0; x < varied_image_size.width; ++x) stripes.col(x).setTo(2 * x / period % 2 == 0 ? 255 : 0);
    images.push_back(stripes);
  }
  for (unsigned seed = 2; seed < 8; ++seed) images.push_back(renderTexture(varied_image_size, seed));
  return images;
}

int allocationsOf(const std::function<void()>& work) {
  const int before = allocations;
  work();
  return allocations - before;
}

TEST(Allocation, IsCounted) {
  if (!EDGESLAM_COUNTS_ALLOCATIONS) GTEST_SKIP() << "not under this sanitizer";
  EXPECT_GE(allocationsOf([] { cv::Mat(10, 10, CV_8U).setTo(1); }), 1);
  EXPECT_GE(allocationsOf([] { std::vector<int> ints(10); }), 1);
  EXPECT_EQ(allocationsOf([] {}), 0);
}

TEST(Allocation, NoneOnTheWayToEdgesAndPointsAfterTheFirstImage) {
  if (!EDGESLAM_COUNTS_ALLOCATIONS) GTEST_SKIP() << "not under this sanitizer";
  const std::vector<cv::Mat> images = variedImages();
  const EdgeOptions edge_options;
  const PointSpread point_options;
  ImagePyramid pyramid;
  EdgeWorkspace edge_workspace;
  EdgeMap edges = makeEdgeMap(varied_image_size);
  PointChoiceWorkspace point_workspace;
  std::vector<ChosenPoint> chosen;
  std::vector<Eigen::Vector2f> occupied;
  double sum = 0;
  for (size_t i = 0; i < images.size(); ++i) {
    const cv::Mat& image = images[i];
    const int of_pyramid = allocationsOf([&] { buildPyramid(image, 4, pyramid); });
    const int of_edges = allocationsOf([&] { detectEdges(pyramid.levels[0], edge_options, edge_workspace, edges); });
    const int of_points =
        allocationsOf([&] { choosePoints(image, edges, occupied, point_options, {}, point_workspace, chosen); });
    const int of_queries = allocationsOf([&] {
      sum += sharpness(image, edges);
      for (const ChosenPoint& point : chosen) {
        sum += nearestEdgePoint(edges, point.pixel, point.normal, 2, 0.7F);
        sum += static_cast<double>(structureTensor(image, point.pixel, 15).l1);
      }
    });
    EXPECT_EQ(of_queries, 0) << "image " << i;
    occupied.clear();
    for (size_t k = 0; k < chosen.size() && i % 2 == 0; ++k) occupied.push_back(chosen[k].pixel);
    if (i == 0) {
      ASSERT_GT(of_pyramid, 0);
      ASSERT_GT(chosen.size(), 300U);
      continue;
    }
    EXPECT_EQ(of_pyramid, 0) << "image " << i;
    EXPECT_EQ(of_edges, 0) << "image " << i;
    EXPECT_EQ(of_points, 0) << "image " << i;
  }
  EXPECT_GT(sum, 0);
}

TEST(Allocation, AMapMadeBeforehandIsFilledWithoutAny) {
  if (!EDGESLAM_COUNTS_ALLOCATIONS) GTEST_SKIP() << "not under this sanitizer";
  const std::vector<cv::Mat> images = variedImages();
  EdgeWorkspace workspace;
  EdgeMap first = makeEdgeMap(varied_image_size);
  detectEdges(images[0], {}, workspace, first);
  for (const cv::Mat& image : images) {
    EdgeMap edges = makeEdgeMap(varied_image_size);
    EXPECT_EQ(allocationsOf([&] { detectEdges(image, {}, workspace, edges); }), 0);
  }
}

}  // namespace
}  // namespace edgeslam
