// Frames from the camera to tracking: preallocated slots, and the newest frame wins when tracking falls behind. What
// was passed over is told, never hidden.
#pragma once

#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>

#include "image_formats/jpeg_decoder.h"
#include "pipeline/triple_buffer.h"

namespace edgeslam {

struct FrameSlot {
  std::int64_t index = 0;  // over all frames of the camera
  std::int64_t time_ns = 0;
  cv::Mat grey;                     // CV_8U of the camera's size
  std::int64_t handed_over_ns = 0;  // steady clock, when capture was done with it
  std::string problem;              // why it could not be read; empty otherwise
  CameraJpeg jpeg;                  // the frame as the camera sent it, where that is kept; null otherwise
};

struct PassedOverFrame {
  std::int64_t index = 0;
  std::int64_t time_ns = 0;
};

class FrameSlots {
 public:
  FrameSlots(int width, int height) : passed_over_(256) {
    for (int i = 0; i < 3; ++i) {
      slots_.writing().grey.create(height, width, CV_8U);
      slots_.publish();
      slots_.take();
    }
  }

  // Capture's side: the slot to fill next, and its handing over.
  FrameSlot& writing() { return slots_.writing(); }
  void publish() {
    const PassedOverFrame published{slots_.writing().index, slots_.writing().time_ns};
    if (slots_.publish()) passed_over_.push(last_published_);
    last_published_ = published;
  }

  // Tracking's side: true where a frame came since, which is then tracking's until the next call.
  bool take() { return slots_.take(); }
  FrameSlot& reading() { return slots_.reading(); }
  // The oldest frame that was passed over and not told yet; false where there is none.
  bool nextPassedOver(PassedOverFrame& frame) { return passed_over_.pop(frame); }

 private:
  TripleBuffer<FrameSlot> slots_;
  PassedOverFrame last_published_;  // capture's alone
  boost::lockfree::spsc_queue<PassedOverFrame> passed_over_;
};

}  // namespace edgeslam
