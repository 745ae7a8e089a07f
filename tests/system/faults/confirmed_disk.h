// What a crash of the whole machine may leave of a folder, told from the log of its steps (file_faults.h): what the
// program wrote and the disk has not confirmed may be gone.
#pragma once

#include <string>

namespace edgeslam {

enum class Loss {
  nothing,      // the process alone was killed
  content,      // names are there, of their files only as many bytes as were synced
  all_it_could  // besides, names whose folder was not synced since are gone, and what they replaced is back
};

// Changes `folder`, in which the logged steps were done, accordingly. `before`: a copy of the folder from before the
// first step.
void lose(Loss loss, const std::string& folder, const std::string& log, const std::string& before);

}  // namespace edgeslam
