#include "bench/timed_work.h"

#include <benchmark/benchmark.h>

#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

namespace edgeslam {

void addTimed(const std::string& name, const std::function<void()>& work) {
  benchmark::RegisterBenchmark(name.c_str(), [work](benchmark::State& state) {
    for (auto _ : state) {
      work();
      benchmark::ClobberMemory();
    }
  })->Unit(benchmark::millisecond);
}

void addCopy(const std::string& kernel, std::size_t touched_bytes) {
  auto from = std::make_shared<std::vector<std::uint8_t>>(touched_bytes / 2 + 1, std::uint8_t{1});
  auto to = std::make_shared<std::vector<std::uint8_t>>(from->size());
  addTimed(kernel + "/copy", [=] {
    std::memcpy(to->data(), from->data(), from->size());
    benchmark::DoNotOptimize(to->data());
  });
}

}  // namespace edgeslam
