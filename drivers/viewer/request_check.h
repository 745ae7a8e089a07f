// Who may see the page and who may command: judged from a request's head alone, before anything is done.
//
// Three kinds of strangers are kept out. Others in the network: by the token. Other web pages in the same browser that
// send requests here (CSRF): a command is JSON, which a page may send across origins only after asking, and that is
// refused; an Origin other than ours is refused, too. Pages whose name is made to point here (DNS rebinding): without a
// token only the names of this computer are served; with one, such a page does not know it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "drivers/viewer/viewer_options.h"

namespace edgeslam {

// What matters of a request. Empty: not given.
struct RequestHead {
  std::string_view method;
  std::string_view target;  // path and query, as sent
  std::string_view host;
  std::string_view origin;
  std::string_view authorization;
  std::string_view content_type;
  std::string_view fetch_site;       // Sec-Fetch-Site
  bool has_repeated_fields = false;  // one of those above twice
};

enum class ViewerRoute { page, stream, command };

struct Refusal {
  int status = 400;  // of HTTP
  std::string message;
};

struct RequestVerdict {
  std::optional<Refusal> refusal;  // where there is one, the route has no meaning
  ViewerRoute route = ViewerRoute::page;
};

constexpr std::size_t longest_target = 1024;

// Paths are compared with those of the table alone: none ever names a file.
RequestVerdict checkRequest(const RequestHead& request, const ViewerOptions& options);

// In a time that depends on the lengths only.
bool isSameSecret(std::string_view given, std::string_view expected);

}  // namespace edgeslam
