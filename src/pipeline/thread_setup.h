// Name, priority and processors of the calling thread. What is not allowed is told and left out.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace edgeslam {

struct ThreadSetup {
  std::string name;             // up to 15 characters
  int real_time_priority = 0;   // SCHED_FIFO, 1 to 99; 0: the usual scheduling
  int nice = 0;                 // without real-time priority: over 0 is lower
  bool batch = false;           // SCHED_BATCH
  std::vector<int> processors;  // empty: all
};

enum class SetupKind { processor, scheduling, nice_level, memory };

// What the system did not allow.
struct RefusedSetup {
  SetupKind kind = SetupKind::processor;
  std::string text;  // what the run does without and why, in a few words
};

// None where all was allowed; of more refusals than one, the last.
std::optional<RefusedSetup> setUpThread(const ThreadSetup& setup);

// Keeps all memory of the process from being swapped out. None where that was allowed.
std::optional<RefusedSetup> lockMemory();

}  // namespace edgeslam
