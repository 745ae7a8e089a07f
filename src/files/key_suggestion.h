// What was probably meant by a key that does not exist.
#pragma once

#include <string>
#include <vector>

namespace edgeslam {

// The known key nearest to `wrong` in edits (insertion, deletion, replacement, swap of two neighbours), or the one of
// the same last name in another section; empty where none is close. The first of equals.
std::string closestKey(const std::string& wrong, const std::vector<std::string>& known);

}  // namespace edgeslam
