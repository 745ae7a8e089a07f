// Several files that belong together: all of them appear, each whole, or none does.
#pragma once

#include <string>
#include <vector>

namespace edgeslam {

struct FileContent {
  std::string name;  // inside the folder
  std::string content;
};

// Makes `folder` if it is missing, writes every file under a temporary name beside its place (PendingFile), has the
// disk confirm them, and only then renames them, replacing files of the same names. Throws InputError with the path and
// the system's reason where that fails, and then removes what it wrote, the folder too if it was made for this.
void writeFileSet(const std::string& folder, const std::vector<FileContent>& files);

}  // namespace edgeslam
