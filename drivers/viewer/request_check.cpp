#include "drivers/viewer/request_check.h"

#include <algorithm>
#include <cctype>

namespace edgeslam {
namespace {

constexpr std::size_t longest_host = 255;

struct Route {
  std::string_view path;
  std::string_view method;
  ViewerRoute route;
};
constexpr Route routes[] = {{"/", "GET", ViewerRoute::page},
                            {"/stream", "GET", ViewerRoute::stream},
                            {"/command", "POST", ViewerRoute::command}};

RequestVerdict refuse(int status, const std::string& message) { return {Refusal{status, message}, ViewerRoute::page}; }

bool isSameWord(std::string_view a, std::string_view b) {
  const auto same = [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); };
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), same);
}

bool startsWith(std::string_view text, std::string_view beginning) {
  return text.substr(0, beginning.size()) == beginning;
}

// Without the port; of "[::1]:80" it is "::1".
std::string nameOf(std::string_view host) {
  if (startsWith(host, "[")) return std::string(host.substr(1, std::min(host.find(']'), host.size()) - 1));
  return std::string(host.substr(0, host.find(':')));
}

bool isHost(std::string_view host) {
  const auto may_be = [](unsigned char c) {
    return std::isalnum(c) || std::string_view(".-_:[]").find(c) != std::string_view::npos;
  };
  return !host.empty() && host.size() <= longest_host && std::all_of(host.begin(), host.end(), may_be);
}

bool isOwnOrigin(std::string_view origin, std::string_view host) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (startsWith(origin, scheme) && isSameWord(origin.substr(scheme.size()), host)) return true;
  }
  return false;
}

bool isJson(std::string_view content_type) {
  std::string_view type = content_type.substr(0, content_type.find(';'));
  while (!type.empty() && type.back() == ' ') type.remove_suffix(1);
  return isSameWord(type, "application/json");
}

// Of the page itself the token comes in the address, as nothing else can carry it; of all that the page asks for, in
// the header.
std::string_view tokenOf(const RequestHead& request, std::string_view path, std::string_view query) {
  constexpr std::string_view bearer = "Bearer ", name = "token=";
  if (startsWith(request.authorization, bearer)) return request.authorization.substr(bearer.size());
  if (path == "/" && startsWith(query, name)) return query.substr(name.size(), query.find('&') - name.size());
  return {};
}

}  // namespace

bool isSameSecret(std::string_view given, std::string_view expected) {
  unsigned char different = given.size() == expected.size() ? 0 : 1;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const char other = expected.empty() ? '\0' : expected[i % expected.size()];
    different = static_cast<unsigned char>(different | (given[i] ^ other));
  }
  return different == 0;
}

RequestVerdict checkRequest(const RequestHead& request, const ViewerOptions& options) {
  if (request.target.size() > longest_target) return refuse(414, "the address is too long");
  if (request.has_repeated_fields) return refuse(400, "a header field is given twice");
  if (!isHost(request.host)) return refuse(400, "a Host is expected");
  const std::string name = nameOf(request.host);
  if (options.token.empty() && !isSameWord(name, "localhost") && !isLoopbackAddress(name)) {
    return refuse(403, "without a token (viewer.token) this page is for this computer only, as localhost or 127.0.0.1");
  }
  const std::string_view path = request.target.substr(0, request.target.find('?'));
  const std::string_view query = request.target.substr(std::min(path.size() + 1, request.target.size()));
  if (!options.token.empty() && !isSameSecret(tokenOf(request, path, query), options.token)) {
    return refuse(401, "the token (viewer.token) is missing or wrong");
  }
  const Route* route =
      std::find_if(std::begin(routes), std::end(routes), [&](const Route& r) { return r.path == path; });
  if (route == std::end(routes)) return refuse(404, "there is nothing at this address");
  if (request.method != route->method) {
    return refuse(405, std::string(path) + " takes " + std::string(route->method) + " only");
  }
  if (!request.origin.empty() && !isOwnOrigin(request.origin, request.host)) {
    return refuse(403, "requests of other web pages are not carried out");
  }
  if (route->route == ViewerRoute::page) return {std::nullopt, route->route};
  if (!request.fetch_site.empty() && request.fetch_site != "same-origin" && request.fetch_site != "none") {
    return refuse(403, "requests of other web pages are not carried out");
  }
  if (route->route == ViewerRoute::command && !isJson(request.content_type)) {
    return refuse(415, "a command is JSON (Content-Type: application/json)");
  }
  return {std::nullopt, route->route};
}

}  // namespace edgeslam
