// Messages as they are sent.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace edgeslam {

template <class Message>
std::vector<std::uint8_t> encoded(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  EXPECT_EQ(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())), static_cast<int>(bytes.size()));
  return bytes;
}

}  // namespace edgeslam
