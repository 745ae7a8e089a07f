#include "pipeline/live_channels.h"

namespace edgeslam {
LiveChannels::LiveChannels(int width, int height, std::size_t observations, bool has_inertia) : frames(width, height) {
  messages.forEachSlot([&](MappingMessage& message) { reserve(observations, has_inertia, message.frame); });
  results.forEachSlot([&](PublishedFrame& published) {
    reserve(observations, published.result);
    published.problem.reserve(longest_reason);
  });
}

}  // namespace edgeslam
