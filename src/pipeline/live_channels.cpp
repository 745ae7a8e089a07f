#include "pipeline/live_channels.h"

namespace edgeslam {
LiveChannels::LiveChannels(int width, int height, std::size_t observations) : frames(width, height) {
  messages.forEachSlot([&](MappingMessage& message) {
    message.frame.observations.reserve(observations);
    message.frame.straight_edges.reserve(observations);
  });
  results.forEachSlot([&](PublishedFrame& published) {
    reserve(observations, published.result);
    published.problem.reserve(longest_reason);
  });
}

}  // namespace edgeslam
