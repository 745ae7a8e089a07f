// Where the page for people is served, checked before anything is opened.
#pragma once

#include <chrono>
#include <string>

namespace edgeslam {

struct ViewerOptions {
  bool enabled = false;
  std::string address = "127.0.0.1";  // of this computer, IPv4 or IPv6, as a number
  int port = 8417;                    // TCP; 0: a free one
  std::string token;                  // empty: none is asked for
};

// How long a client may take; one that takes longer is dropped.
struct ViewerPatience {
  std::chrono::milliseconds request{10000};  // for all of a request
  std::chrono::milliseconds response{20000};
  std::chrono::milliseconds message{10000};  // to take in one message of the stream
};

// 127.0.0.0/8 and ::1. False for what is no address.
bool isLoopbackAddress(const std::string& address);

// Empty, or what is wrong with the key of that name ("address", "token"): "viewer.address: ...".
//
// An address that others reach needs a token, and none is made up for it: the service would have another one after each
// start, and would write it into the journal.
std::string viewerProblem(const ViewerOptions& options);

}  // namespace edgeslam
