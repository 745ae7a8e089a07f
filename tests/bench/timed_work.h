// Benchmarks of work that is given as a function, and of a copy of as many bytes beside it.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace edgeslam {

// Registers `work` as the benchmark KERNEL/VARIANT.
void addTimed(const std::string& name, const std::function<void()>& work);

// Registers KERNEL/copy: the time of reading and of writing once the bytes that a kernel at least reads and writes,
// `touched_bytes` of them together, half of them each.
void addCopy(const std::string& kernel, std::size_t touched_bytes);

}  // namespace edgeslam
