// Figures that a run may lack, as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

namespace edgeslam {

// null where there is none.
inline nlohmann::ordered_json optionalJson(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

}  // namespace edgeslam
