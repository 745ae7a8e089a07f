#include "drivers/viewer/viewer_options.h"

#include <arpa/inet.h>

#include <algorithm>
#include <cstring>

namespace edgeslam {
namespace {

constexpr std::size_t shortest_token = 16, longest_token = 128;

bool isTokenCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

bool isAddress(const std::string& address) {
  in6_addr bytes{};
  return inet_pton(AF_INET, address.c_str(), &bytes) == 1 || inet_pton(AF_INET6, address.c_str(), &bytes) == 1;
}

}  // namespace

bool isLoopbackAddress(const std::string& address) {
  in_addr four{};
  if (inet_pton(AF_INET, address.c_str(), &four) == 1) return (ntohl(four.s_addr) >> 24) == 127;
  in6_addr six{};
  return inet_pton(AF_INET6, address.c_str(), &six) == 1 && std::memcmp(&six, &in6addr_loopback, sizeof(six)) == 0;
}

std::string viewerProblem(const ViewerOptions& options) {
  if (!isAddress(options.address)) {
    return "viewer.address: '" + options.address + "' is no address; expected numbers such as 127.0.0.1 or 0.0.0.0";
  }
  const std::string& token = options.token;
  if (token.empty() && options.enabled && !isLoopbackAddress(options.address)) {
    return "viewer.address: others reach " + options.address +
           ", so viewer.token is needed (`openssl rand -hex 16` makes one)";
  }
  if (token.empty()) return "";
  const bool good = token.size() >= shortest_token && token.size() <= longest_token &&
                    std::all_of(token.begin(), token.end(), isTokenCharacter);
  return good ? "" : "viewer.token: expected 16 to 128 letters, digits, - and _";
}

}  // namespace edgeslam
