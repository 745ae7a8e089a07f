// Between the threads of a run and the viewer's: newest values and bounded queues, so that neither waits for the other.
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <memory>
#include <string>

#include "drivers/lcm/commands.h"
#include "drivers/viewer/view_messages.h"
#include "map/map.h"
#include "pipeline/channel.h"
#include "pipeline/frame_look.h"

namespace edgeslam {

struct ViewedAnswer {
  std::int64_t command = 0;  // its number
  bool accepted = false;
  std::string message;
};

struct WorldOfMap {
  std::shared_ptr<const Map> map;
  int world = 0;
};

struct ViewFeed {
  static constexpr std::size_t most_commands = 8;  // that wait for their answer

  FrameLooks looks;                                                                  // from tracking
  boost::lockfree::spsc_queue<FrameSample, boost::lockfree::capacity<256>> samples;  // from publishing
  TripleBuffer<ViewedState> states;                                                  // likewise
  TripleBuffer<WorldOfMap> maps;                                                     // likewise
  Channel<Command> commands{most_commands};                                          // to publishing
  Channel<ViewedAnswer> answers{most_commands};                                      // from publishing
  std::atomic<bool> is_watched{false};
};

}  // namespace edgeslam
