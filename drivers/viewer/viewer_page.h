// The page, embedded at build time: one HTML text with its style and its scripts, three.js among them.
#pragma once

#include <string>

namespace edgeslam {

// `nonce`: what marks the page's own scripts (Content-Security-Policy).
std::string viewerPage(const std::string& nonce);

}  // namespace edgeslam
