// What the threads of a live run hand to each other, and how each learns that the run ends. Every queue has one thread
// that fills it and one that empties it.
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <chrono>
#include <cstdint>
#include <string>

#include "inertia/inertial_unit.h"
#include "pipeline/channel.h"
#include "pipeline/frame_slots.h"
#include "pipeline/messages.h"
#include "pipeline/semaphore.h"
#include "pipeline/triple_buffer.h"
#include "tracking/frame_result.h"
#include "wheels/odometry_pose.h"

namespace edgeslam {

// A frame's result on its way out.
struct PublishedFrame {
  FrameResult result;
  std::string problem;       // why the frame could not be read; empty otherwise
  std::int64_t sent_ns = 0;  // steady clock
};

// Before this message was handled, mapping applied this correction.
struct AppliedCorrection {
  std::int64_t message = 0, number = 0;
};

constexpr std::chrono::milliseconds idle_time{1};  // before a thread looks again for what it waits for

enum class Stopping { no, settle, at_once };

struct LiveChannels {
  // Frames of this size [px]; messages and results that hold so many observations, and what an inertial unit measures,
  // without taking memory.
  LiveChannels(int width, int height, std::size_t observations, bool has_inertia);

  FrameSlots frames;                                          // capture to tracking
  boost::lockfree::spsc_queue<InertialSample> inertia{4096};  // from outside to tracking: a second of the fastest units
  boost::lockfree::spsc_queue<OdometryPose> wheels{1024};     // likewise
  Channel<MappingMessage> messages{64};                       // tracking to mapping
  TripleBuffer<MapUpdate> updates;                            // mapping to tracking
  boost::lockfree::spsc_queue<AppliedCorrection> applied{1024};  // mapping to tracking, for the sink
  Channel<Snapshot> snapshots{1};                                // mapping to places
  Channel<Correction> corrections{2};                            // places to mapping
  Channel<PublishedFrame> results{256};                          // tracking to publishing
  Channel<MappingReport> reports{256};                           // mapping to publishing

  Semaphore frame_ready;   // a frame for tracking, or the end
  Semaphore result_ready;  // a result or a report for publishing, or the end
  std::atomic<Stopping> stopping{Stopping::no};
  std::atomic<bool> tracking_ended{false}, mapping_ended{false};
};

}  // namespace edgeslam
