// Where the next recording goes.
#pragma once

#include <string>

namespace edgeslam {

// By the time (UTC): "recordings/20250131T235959Z", with a number where that is taken. Makes `parent`, not the folder.
// Throws InputError where `parent` is empty: none is configured.
std::string nextRecordingFolder(const std::string& parent);

}  // namespace edgeslam
