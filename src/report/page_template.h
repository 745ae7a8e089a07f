// Pages put together from a template and data: what comes from outside stays text in them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace edgeslam {

// Text for HTML, outside of tags or in a quoted attribute.
std::string escapedForHtml(std::string_view text);

// JSON for a script element: nothing in it can end that element. What is not UTF-8 is replaced.
std::string escapedForScript(const nlohmann::ordered_json& data);

// The page with each {{name}} replaced by the part of that name, or by nothing where there is none. Parts are not
// searched again: braces in them stay what they are.
std::string filledIn(std::string_view page, const std::vector<std::pair<std::string_view, std::string_view>>& parts);

}  // namespace edgeslam
