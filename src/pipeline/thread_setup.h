// Name, priority and processors of the calling thread. What is not allowed is told, and the run goes on without.
#pragma once

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

// Empty, or what the thread does without and why, in a few words.
std::string setUpThread(const ThreadSetup& setup);

// Keeps all memory of the process from being swapped out. Empty, or what it does without and why.
std::string lockMemory();

}  // namespace edgeslam
