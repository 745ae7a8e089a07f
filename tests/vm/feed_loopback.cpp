// A recording as the picture of a v4l2loopback camera, there and back until it is ended; for the service's checks in
// the virtual machine. SIGUSR1 puts a hand on the lens, SIGUSR2 takes it away.
//
// usage: feed_loopback DEVICE RECORDING FRAMES_PER_SECOND
#include <signal.h>

#include <cstdlib>
#include <exception>
#include <iostream>

#include "frames/frame_source.h"
#include "recording/open_frame_source.h"
#include "vm/loopback_feeder.h"

namespace edgeslam {
namespace {

std::vector<cv::Mat> framesOf(const std::string& recording) {
  std::vector<cv::Mat> frames;
  const auto source = openFrameSource(recording);
  while (const std::optional<Frame> frame = source->next()) {
    if (!frame->grey.empty()) frames.push_back(frame->grey.clone());
  }
  return frames;
}

void feed(const std::string& device, const std::string& recording, double frames_per_second) {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int number : {SIGUSR1, SIGUSR2, SIGTERM, SIGINT}) sigaddset(&signals, number);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  LoopbackFeeder feeder(device, framesOf(recording), frames_per_second, FeedingOrder::there_and_back);
  for (int number = 0; sigwait(&signals, &number) == 0;) {
    if (number == SIGTERM || number == SIGINT) return;
    feeder.cover(number == SIGUSR1);
  }
}

}  // namespace
}  // namespace edgeslam

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: feed_loopback DEVICE RECORDING FRAMES_PER_SECOND\n";
    return 2;
  }
  try {
    edgeslam::feed(argv[1], argv[2], std::atof(argv[3]));
  } catch (const std::exception& error) {
    std::cerr << "feed_loopback: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
