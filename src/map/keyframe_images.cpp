#include "map/keyframe_images.h"

#include <mutex>
#include <optional>

#include "map/packed_image.h"

namespace edgeslam {
namespace {

std::size_t sizeOf(const ImagePyramid& pyramid) {
  std::size_t bytes = 0;
  for (const cv::Mat& level : pyramid.levels) bytes += level.total() * level.elemSize();
  return bytes;
}

}  // namespace

// At least one of `images` and `packed` is there.
struct KeyframeImages::Content {
  explicit Content(std::shared_ptr<const FrameImages> its_images)
      : frame_index(its_images->frame_index),
        time_ns(its_images->time_ns),
        levels(static_cast<int>(its_images->pyramid.levels.size())),
        size(sizeOf(its_images->pyramid)),
        images(std::move(its_images)) {}

  const std::int64_t frame_index, time_ns;
  const int levels;
  const std::size_t size;
  std::mutex mutex;
  std::shared_ptr<const FrameImages> images;
  std::optional<PackedImage> packed;
};

KeyframeImages::KeyframeImages(std::shared_ptr<const FrameImages> images) {
  if (images) content_ = std::make_shared<Content>(std::move(images));
}

std::shared_ptr<const FrameImages> KeyframeImages::get() const {
  if (!content_) return nullptr;
  const std::lock_guard<std::mutex> lock(content_->mutex);
  if (!content_->images) {
    auto images = std::make_shared<FrameImages>();
    images->frame_index = content_->frame_index;
    images->time_ns = content_->time_ns;
    buildPyramid(unpacked(*content_->packed), content_->levels, images->pyramid);
    content_->images = std::move(images);
  }
  return content_->images;
}

bool KeyframeImages::pack() const {
  if (!content_) return false;
  const std::lock_guard<std::mutex> lock(content_->mutex);
  // Others get them here alone, so that nobody can begin to hold them now.
  if (content_->images.use_count() != 1 || content_->levels == 0) return false;
  if (!content_->packed) content_->packed = packed(content_->images->pyramid.levels.front());
  content_->images.reset();
  return true;
}

std::size_t KeyframeImages::size() const { return content_ ? content_->size : 0; }

}  // namespace edgeslam
