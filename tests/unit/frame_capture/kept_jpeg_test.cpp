#include "drivers/frame_capture/kept_jpeg.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

TEST(KeptJpeg, IsTheBufferAsItWasAndOnlyWhereItIsAskedFor) {
  std::vector<unsigned char> buffer{0xFF, 0xD8, 1, 2, 3, 0, 0xFF, 0xD9};
  const std::vector<unsigned char> sent = buffer;
  KeptJpeg kept;
  EXPECT_EQ(kept.of(PixelFormat::mjpeg, buffer.data(), buffer.size()), nullptr);
  kept.keep(true);
  EXPECT_EQ(kept.of(PixelFormat::yuyv, buffer.data(), buffer.size()), nullptr);
  const CameraJpeg jpeg = kept.of(PixelFormat::mjpeg, buffer.data(), buffer.size());
  ASSERT_TRUE(jpeg);
  std::fill(buffer.begin(), buffer.end(), 0);  // the driver has it again
  EXPECT_EQ(*jpeg, sent);
  kept.keep(false);
  EXPECT_EQ(kept.of(PixelFormat::mjpeg, buffer.data(), buffer.size()), nullptr);
}

TEST(KeptJpeg, TakesTheMemoryOfFramesThatWereLetGo) {
  const std::vector<unsigned char> buffer(5000, 7);
  KeptJpeg kept;
  kept.keep(true);
  CameraJpeg held = kept.of(PixelFormat::mjpeg, buffer.data(), buffer.size());
  const unsigned char* const first = held->data();
  const CameraJpeg second = kept.of(PixelFormat::mjpeg, buffer.data(), buffer.size());
  EXPECT_NE(second->data(), first) << "while it is held, it is left alone";
  held.reset();
  EXPECT_EQ(kept.of(PixelFormat::mjpeg, buffer.data(), 300)->data(), first);
}

}  // namespace
}  // namespace edgeslam
