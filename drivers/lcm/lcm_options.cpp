#include "drivers/lcm/lcm_options.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <set>
#include <vector>

namespace edgeslam {
namespace {

constexpr std::size_t longest_channel = 63;  // LCM_MAX_CHANNEL_NAME_LENGTH
const char* const default_url = "udpm://239.255.76.67:7667?ttl=0";

struct UrlParts {
  std::string provider, network, arguments;
};

[[noreturn]] void refuse(const std::string& url, const std::string& problem) {
  throw InputError("LCM URL '" + url + "': " + problem);
}

UrlParts partsOf(const std::string& url) {
  const std::size_t colon = url.find("://");
  if (colon == std::string::npos) refuse(url, "expected PROVIDER://NETWORK, such as " + std::string(default_url));
  UrlParts parts;
  parts.provider = url.substr(0, colon);
  const std::string rest = url.substr(colon + 3);
  const std::size_t question = rest.find('?');
  parts.network = rest.substr(0, question);
  if (question != std::string::npos) parts.arguments = rest.substr(question + 1);
  const std::array<const char*, 4> providers{"udpm", "tcpq", "memq", "file"};
  if (std::find(providers.begin(), providers.end(), parts.provider) == providers.end()) {
    refuse(url, "'" + parts.provider + "' is no provider; expected udpm, tcpq, memq or file");
  }
  return parts;
}

// A whole number from `least` to `largest` that fills the text; -1 otherwise.
int wholeNumber(const std::string& text, int least, int largest) {
  if (text.empty() || text.size() > 5 || text.find_first_not_of("0123456789") != std::string::npos) return -1;
  const int number = std::stoi(text);
  return number >= least && number <= largest ? number : -1;
}

// Calls `use(name, value)` for each of name=value&name=value.
template <typename Use>
void forEachArgument(const std::string& arguments, const Use& use) {
  for (std::size_t at = 0; at < arguments.size();) {
    const std::size_t end = std::min(arguments.find('&', at), arguments.size());
    const std::string argument = arguments.substr(at, end - at);
    const std::size_t equals = std::min(argument.find('='), argument.size());
    use(argument.substr(0, equals), equals < argument.size() ? argument.substr(equals + 1) : "");
    at = end + 1;
  }
}

}  // namespace

std::string effectiveUrl(const LcmOptions& options) {
  std::string url = options.url;
  if (url.empty()) {
    const char* from_environment = std::getenv("LCM_DEFAULT_URL");
    url = from_environment && *from_environment ? from_environment : default_url;
  }
  const UrlParts parts = partsOf(url);
  if (parts.provider == "udpm" && options.time_to_live >= 0) {
    if (options.time_to_live > 255) refuse(url, "a time to live is 0 to 255");
    std::string arguments;
    forEachArgument(parts.arguments, [&](const std::string& name, const std::string& value) {
      if (name != "ttl") arguments += name + "=" + value + "&";
    });
    url = "udpm://" + parts.network + "?" + arguments + "ttl=" + std::to_string(options.time_to_live);
  }
  multicastGroup(url);
  return url;
}

void checkChannels(const LcmOptions& options) {
  std::set<std::string> names;
  std::vector<std::string> channels{options.pose_channel,       options.odometry_channel,  options.odom_channel,
                                    options.correction_channel, options.state_channel,     options.status_channel,
                                    options.map_channel,        options.map_lines_channel, options.command_channel,
                                    options.answer_channel};
  if (!options.wheels_channel.empty()) channels.push_back(options.wheels_channel);
  if (!options.imu_channel.empty()) channels.push_back(options.imu_channel);
  for (const std::string& name : channels) {
    const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
      return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
    });
    if (name.empty() || name.size() > longest_channel || !plain) {
      throw InputError("LCM channel '" + name + "': expected 1 to 63 letters, digits and underscores");
    }
    if (!names.insert(name).second) throw InputError("LCM channel '" + name + "' is named twice");
  }
}

std::optional<MulticastGroup> multicastGroup(const std::string& url) {
  const UrlParts parts = partsOf(url);
  if (parts.provider != "udpm") return std::nullopt;
  MulticastGroup group;
  const std::size_t colon = std::min(parts.network.find(':'), parts.network.size());
  if (colon > 0) group.address = parts.network.substr(0, colon);
  in_addr address{};
  if (inet_pton(AF_INET, group.address.c_str(), &address) != 1 || !IN_MULTICAST(ntohl(address.s_addr))) {
    refuse(url, "'" + group.address + "' is no multicast group; expected 224.0.0.0 to 239.255.255.255");
  }
  if (colon < parts.network.size()) {
    const std::string port = parts.network.substr(colon + 1);
    group.port = wholeNumber(port, 1, 65535);
    if (group.port < 0) refuse(url, "'" + port + "' is no port; expected 1 to 65535");
  }
  forEachArgument(parts.arguments, [&](const std::string& name, const std::string& value) {
    if (name != "ttl") return;
    group.time_to_live = wholeNumber(value, 0, 255);
    if (group.time_to_live < 0) refuse(url, "'" + value + "' is no time to live; expected 0 to 255");
  });
  return group;
}

bool canReceive(const std::string& url) {
  const std::string provider = partsOf(url).provider;
  return provider == "udpm" || provider == "tcpq";
}

std::string multicastRouteProblem(const MulticastGroup& group) {
  const int trial = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (trial < 0) return std::string("LCM: no socket can be opened (") + std::strerror(errno) + ")";
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(group.port));
  inet_pton(AF_INET, group.address.c_str(), &to.sin_addr);
  // Sends nothing: looks for a route.
  const int outcome = connect(trial, reinterpret_cast<const sockaddr*>(&to), sizeof(to));
  const int error = errno;
  close(trial);
  if (outcome == 0) return "";
  const std::string device = group.time_to_live == 0 ? "lo" : "INTERFACE";
  return "LCM: no route to the multicast group " + group.address + " (" + std::strerror(error) +
         "); add one: ip route add 224.0.0.0/4 dev " + device;
}

}  // namespace edgeslam
