// Messages of the stream, put together: little-endian numbers behind a description in JSON.
#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "drivers/viewer/view_messages.h"

namespace edgeslam {

inline std::string beginMessage(ViewMessage kind) { return std::string(1, static_cast<char>(kind)); }

inline std::string textOf(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

template <typename Whole>
void append(std::string& message, Whole number) {
  for (std::size_t i = 0; i < sizeof(Whole); ++i) {
    message.push_back(static_cast<char>(static_cast<std::uint64_t>(number) >> (8 * i) & 0xFF));
  }
}

inline void appendFloat(std::string& message, float number) {
  std::uint32_t bits = 0;
  static_assert(sizeof(bits) == sizeof(number));
  std::memcpy(&bits, &number, sizeof(bits));
  append(message, bits);
}

inline std::string beginBinary(ViewMessage kind, const nlohmann::json& description) {
  const std::string text = textOf(description);
  std::string message = beginMessage(kind);
  append(message, static_cast<std::uint32_t>(text.size()));
  return message + text;
}

}  // namespace edgeslam
