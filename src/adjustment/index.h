// Places in lists: the bundle counts in `int`, where -1 is none.
#pragma once

#include <cstddef>

namespace edgeslam {

constexpr std::size_t at(int index) { return static_cast<std::size_t>(index); }

}  // namespace edgeslam
