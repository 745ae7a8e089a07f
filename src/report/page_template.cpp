#include "report/page_template.h"

#include <nlohmann/json.hpp>

namespace edgeslam {

std::string escapedForHtml(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

// Within JSON '<' stands only inside strings, where the escape means the same: so nothing can end the script element.
std::string escapedForScript(const nlohmann::ordered_json& data) {
  const std::string json = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string result;
  result.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      result += "\\u003c";
    } else {
      result += c;
    }
  }
  return result;
}

std::string filledIn(std::string_view page, const std::vector<std::pair<std::string_view, std::string_view>>& parts) {
  std::string result;
  std::size_t position = 0;
  while (position < page.size()) {
    const std::size_t open = page.find("{{", position);
    if (open == std::string_view::npos) break;
    const std::size_t close = page.find("}}", open);
    if (close == std::string_view::npos) break;
    result += page.substr(position, open - position);
    const std::string_view name = page.substr(open + 2, close - open - 2);
    for (const auto& [part, content] : parts) {
      if (part == name) result += content;
    }
    position = close + 2;
  }
  result += page.substr(position);
  return result;
}

}  // namespace edgeslam
