// Files that are there whole or not at all.
#pragma once

#include <string>
#include <string_view>

namespace edgeslam {

// Writes `content` to a temporary file in the same folder, syncs it, and renames it to `path`, replacing what was
// there. Throws InputError with path and the system's reason (full disk, folder that cannot be written), leaving
// neither the temporary file nor a changed `path` behind.
void writeFileAtomically(const std::string& path, std::string_view content);

}  // namespace edgeslam
