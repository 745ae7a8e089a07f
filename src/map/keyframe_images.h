// The images of a keyframe, which take little memory while nobody looks at them: of those the finest level is kept,
// packed without loss, and the others are made from it again.
#pragma once

#include <cstdint>
#include <memory>

#include "image/pyramid.h"

namespace edgeslam {

// The images of a frame; shared, never changed once made.
struct FrameImages {
  std::int64_t frame_index = 0;
  std::int64_t time_ns = 0;
  ImagePyramid pyramid;
};

// A value like a std::shared_ptr<const FrameImages>: its copies share the images, and know them by the same place in
// memory. Every function may be called by several threads at once. They take locks: they are not for tracking's thread.
class KeyframeImages {
 public:
  KeyframeImages() = default;
  KeyframeImages(std::nullptr_t) {}
  KeyframeImages(std::shared_ptr<const FrameImages> images);
  template <typename Images>
  KeyframeImages(std::shared_ptr<Images> images) : KeyframeImages(std::shared_ptr<const FrameImages>(images)) {}

  explicit operator bool() const { return content_ != nullptr; }
  void reset() { content_.reset(); }

  // The images, or null. A reference into them is good for as long as what is returned is held.
  std::shared_ptr<const FrameImages> get() const;
  std::shared_ptr<const FrameImages> operator->() const { return get(); }

  // Packs the images where nobody holds them; get() unpacks them. False where there was nothing to do.
  bool pack() const;

  // Of all levels, as they are when they are looked at [bytes].
  std::size_t size() const;

 private:
  struct Content;
  std::shared_ptr<Content> content_;
};

}  // namespace edgeslam
