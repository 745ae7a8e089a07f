// A disk that fails when a test wants it to: takes the place of the C library's functions that change files, counts
// their calls ("steps"), and lets one of them end the process, fail, or take long. Linked into a test it is set up by
// setFaults(); preloaded (LD_PRELOAD=libfile_faults.so) by the environment, see faultEnvironment().
#pragma once

#include <string>
#include <vector>

namespace edgeslam {

enum class Fault {
  none,
  cut_before,  // the process is killed before step `first` happens
  cut_within,  // after half the bytes, where the step writes some; otherwise right after it
  no_space,    // from step `first` on what needs space fails with ENOSPC
  read_only,  // from step `first` on what changes a folder or asks the disk to confirm fails with EROFS, as ext4 has it
  broken,     // from step `first` on what transfers data fails with EIO
  slow,       // from step `first` on each takes 50 ms
  stuck       // from step `first` on none ends while `while_exists` is there
};

struct FaultPlan {
  std::string under;  // only files in this folder and below (as the kernel names it, without links)
  Fault fault = Fault::none;
  long first = 1;            // steps are counted from 1
  std::string while_exists;  // failing and slowness last only while this file is there; empty: always
  std::string log;           // file that gets a line a step, "NUMBER CALL PATH [MORE]"; empty: none
};

// For this process, from now on; counts anew.
void setFaults(const FaultPlan& plan);
// Steps since then.
long faultSteps();

// Of a process to be started with the preloaded library: "NAME=VALUE" for each.
std::vector<std::string> faultEnvironment(const std::string& library, const FaultPlan& plan);

}  // namespace edgeslam
