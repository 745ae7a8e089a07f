// Watches one thread of the program: every allocation, every release of memory and every lock that it makes goes
// through functions of this program, which count them; a system call that is not allowed there ends in a signal that is
// counted.
#pragma once

#include <string>

namespace edgeslam {

struct Trespasses {
  int allocations = 0;
  int releases = 0;
  int locks = 0;
  int system_calls = 0;
  std::string where;  // the calls that led to the first of them
};

// From now on a thread that names itself so (pthread_setname_np) is watched until it ends. One at a time. Allowed are
// the clock, waiting for and waking other threads by semaphores, and ending.
void watchThreadNamed(const std::string& name);

// What it did so far; forgets it.
Trespasses takeTrespasses();

// False under sanitizers, which have their own allocator and make system calls of their own.
bool canWatchThreads();

}  // namespace edgeslam
