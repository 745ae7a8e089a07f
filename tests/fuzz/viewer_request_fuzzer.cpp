// What a browser sends: a request's head, a field a line, then a command's body. Whoever has no token or comes from
// another page gets nothing; a command within its limits, or one line of reason.
#include <algorithm>
#include <array>

#include "drivers/viewer/command_request.h"
#include "drivers/viewer/request_check.h"
#include "fuzz_input.h"

namespace edgeslam {
namespace {

constexpr std::size_t fields = 8;

RequestHead headOf(std::string_view text) {
  std::array<std::string_view, fields> lines;
  for (std::string_view& line : lines) {
    line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  return {lines[0], lines[1], lines[2], lines[3], lines[4], lines[5], lines[6], lines[7] == "repeated"};
}

void checkHead(const RequestHead& head, const std::string& token) {
  ViewerOptions options;
  options.token = token;
  const RequestVerdict verdict = checkRequest(head, options);
  if (verdict.refusal) {
    require(verdict.refusal->status >= 400 && verdict.refusal->status < 500, "a refusal is the client's fault");
    requireMessage(verdict.refusal->message, "");
    return;
  }
  require(!head.has_repeated_fields && head.target.size() <= longest_target, "heads are in order");
  require(head.method == (verdict.route == ViewerRoute::command ? "POST" : "GET"), "the method is the route's");
  const bool named =
      head.target.find(token) != std::string_view::npos || head.authorization.find(token) != std::string_view::npos;
  require(named, "without the token nothing is given");
  const std::string host(head.host);
  if (token.empty()) {
    require(host.rfind("127.", 0) == 0 || host.rfind("[::1]", 0) == 0 || host.size() >= 9,
            "without a token names of this computer are served");
  }
  const std::string origin(head.origin);
  require(origin.empty() || origin.rfind("http", 0) == 0, "other pages get nothing");
  if (verdict.route == ViewerRoute::command) {
    require(head.fetch_site != "cross-site" && head.fetch_site != "same-site", "other pages do not command");
    require(!head.content_type.empty(), "a command is JSON");
  }
}

}  // namespace
}  // namespace edgeslam

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edgeslam;
  const std::vector<std::string_view> parts = splitFiles(data, size, 2);
  checkHead(headOf(parts[0]), "");
  checkHead(headOf(parts[0]), "0123456789abcdef");
  const CommandRequest request = readCommandRequest(parts[1], 7);
  require(request.command.has_value() == request.problem.empty(), "a command is done or refused");
  if (!request.command) {
    requireMessage(request.problem, "");
    require(commandAnswerText(false, request.problem).find('\n') == std::string::npos, "an answer is a line");
    return 0;
  }
  require(request.command->id == 7 && request.command->sender == CommandSender::viewer, "its answer goes to the page");
  if (request.command->kind == CommandKind::set_scale) {
    require(request.command->distance_m > 0 && request.command->distance_m <= 1e5, "distances are possible ones");
    require(request.command->from_utime < request.command->to_utime, "the way goes forward in time");
  }
  return 0;
}
