// Who is let in: addresses, tokens, and requests of other web pages.
#include "drivers/viewer/request_check.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

const std::string secret = "0123456789abcdef";

ViewerOptions open() { return ViewerOptions(); }
ViewerOptions guarded() {
  ViewerOptions options;
  options.token = secret;
  options.address = "0.0.0.0";
  return options;
}

RequestHead commandHead() {
  RequestHead head;
  head.method = "POST";
  head.target = "/command";
  head.host = "localhost:8417";
  head.origin = "http://localhost:8417";
  head.content_type = "application/json";
  head.fetch_site = "same-origin";
  return head;
}

RequestHead pageHead() {
  RequestHead head;
  head.method = "GET";
  head.target = "/";
  head.host = "127.0.0.1:8417";
  return head;
}

int statusOf(const RequestHead& head, const ViewerOptions& options) {
  const RequestVerdict verdict = checkRequest(head, options);
  return verdict.refusal ? verdict.refusal->status : 200;
}

TEST(RequestCheck, ThePageAndItsOwnRequestsAreServed) {
  EXPECT_EQ(statusOf(pageHead(), open()), 200);
  EXPECT_EQ(statusOf(commandHead(), open()), 200);
  EXPECT_EQ(checkRequest(commandHead(), open()).route, ViewerRoute::command);
  RequestHead stream = commandHead();
  stream.method = "GET";
  stream.target = "/stream";
  EXPECT_EQ(checkRequest(stream, open()).route, ViewerRoute::stream);
  EXPECT_EQ(statusOf(stream, open()), 200);
}

TEST(RequestCheck, WithoutATokenOnlyNamesOfThisComputerAreServed) {
  for (const char* host : {"localhost", "LOCALHOST:1", "127.0.0.1", "127.1.2.3:80", "[::1]:8417", "[::1]"}) {
    RequestHead head = pageHead();
    head.host = host;
    EXPECT_EQ(statusOf(head, open()), 200) << host;
  }
  // Names that are made to point here (DNS rebinding).
  for (const char* host : {"evil.example", "localhost.evil.example", "127.0.0.1.evil.example", "192.168.1.4:8417",
                           "[::2]", "[::1", "0.0.0.0", "1127.0.0.1"}) {
    RequestHead head = pageHead();
    head.host = host;
    EXPECT_EQ(statusOf(head, open()), host == std::string("[::1") ? 200 : 403) << host;
  }
}

TEST(RequestCheck, AHostIsNeeded) {
  for (const std::string& host : {std::string(), std::string("a b"), std::string("a/b"), std::string("a@b"),
                                  std::string("\x80"), std::string(300, 'a')}) {
    RequestHead head = pageHead();
    head.host = host;
    EXPECT_EQ(statusOf(head, open()), 400) << host;
  }
  RequestHead twice = pageHead();
  twice.has_repeated_fields = true;
  EXPECT_EQ(statusOf(twice, open()), 400);
}

TEST(RequestCheck, TheTokenIsAskedForOfEverything) {
  for (RequestHead head : {pageHead(), commandHead()}) {
    EXPECT_EQ(statusOf(head, guarded()), 401);
    for (const char* wrong : {"Bearer 0123456789abcdeF", "Bearer 0123456789abcde", "Bearer 0123456789abcdef0",
                              "Bearer ", "0123456789abcdef", "bearer 0123456789abcdef", "Basic 0123456789abcdef"}) {
      head.authorization = wrong;
      EXPECT_EQ(statusOf(head, guarded()), 401) << wrong;
    }
    head.authorization = "Bearer 0123456789abcdef";
    EXPECT_EQ(statusOf(head, guarded()), 200);
    head.host = "robot.local:8417";
    if (!head.origin.empty()) head.origin = "http://robot.local:8417";
    EXPECT_EQ(statusOf(head, guarded()), 200) << "with the token any name of the robot does";
  }
  RequestHead unknown = pageHead();
  unknown.target = "/nothing";
  EXPECT_EQ(statusOf(unknown, guarded()), 401) << "strangers are told nothing";
}

TEST(RequestCheck, InTheAddressTheTokenIsThePagesAlone) {
  RequestHead page = pageHead();
  page.target = "/?token=0123456789abcdef";
  EXPECT_EQ(statusOf(page, guarded()), 200);
  page.target = "/?token=0123456789abcdef&more=1";
  EXPECT_EQ(statusOf(page, guarded()), 200);
  page.target = "/?token=";
  EXPECT_EQ(statusOf(page, guarded()), 401);
  RequestHead command = commandHead();
  command.target = "/command?token=0123456789abcdef";
  EXPECT_EQ(statusOf(command, guarded()), 401);
}

TEST(RequestCheck, OtherWebPagesCannotCommand) {
  for (const char* origin : {"http://evil.example", "null", "http://localhost", "http://localhost:8418",
                             "http://localhost:8417.evil.example", "file://localhost:8417", "localhost:8417"}) {
    RequestHead head = commandHead();
    head.origin = origin;
    EXPECT_EQ(statusOf(head, open()), 403) << origin;
  }
  for (const char* site : {"cross-site", "same-site", "anything"}) {
    RequestHead head = commandHead();
    head.fetch_site = site;
    EXPECT_EQ(statusOf(head, open()), 403) << site;
  }
  // What a form or a picture of another page can send without asking.
  for (const char* type : {"", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x",
                           "text/plain; application/json"}) {
    RequestHead head = commandHead();
    head.content_type = type;
    EXPECT_EQ(statusOf(head, open()), 415) << type;
  }
  RequestHead asking = commandHead();
  asking.method = "OPTIONS";
  EXPECT_EQ(statusOf(asking, open()), 405);
  RequestHead typed = commandHead();
  typed.content_type = "Application/JSON; charset=utf-8";
  EXPECT_EQ(statusOf(typed, open()), 200);
  typed.origin = "https://localhost:8417";
  EXPECT_EQ(statusOf(typed, open()), 200) << "behind a proxy";
}

TEST(RequestCheck, NothingElseIsThere) {
  for (const char* target : {"/index.html", "/../../etc/passwd", "//", "/%2e%2e/etc/passwd", "/command/", "/stream/..",
                             "http://localhost/", "*", "", "/\\..\\x"}) {
    RequestHead head = pageHead();
    head.target = target;
    EXPECT_EQ(statusOf(head, open()), 404) << target;
  }
  RequestHead head = pageHead();
  const std::string long_target = "/?" + std::string(longest_target, 'x');
  head.target = long_target;
  EXPECT_EQ(statusOf(head, open()), 414);
  for (const char* method : {"POST", "PUT", "DELETE", "HEAD", "TRACE", "CONNECT"}) {
    RequestHead other = pageHead();
    other.method = method;
    EXPECT_EQ(statusOf(other, open()), 405) << method;
  }
}

TEST(RequestCheck, SecretsAreComparedWhole) {
  EXPECT_TRUE(isSameSecret("abc", "abc"));
  for (const char* other : {"", "ab", "abcd", "abcabc", "Abc", "abC"})
    EXPECT_FALSE(isSameSecret(other, "abc")) << other;
  EXPECT_FALSE(isSameSecret(std::string_view("abc\0", 4), "abc"));
}

TEST(ViewerOptions, OpenToOthersATokenIsNeeded) {
  ViewerOptions options;
  options.enabled = true;
  for (const char* address : {"127.0.0.1", "127.9.9.9", "::1"}) {
    options.address = address;
    EXPECT_EQ(viewerProblem(options), "") << address;
  }
  for (const char* address : {"0.0.0.0", "192.168.1.4", "::", "::ffff:127.0.0.1"}) {
    options.address = address;
    options.token.clear();
    EXPECT_NE(viewerProblem(options).find("viewer.token is needed"), std::string::npos) << address;
    options.token = secret;
    EXPECT_EQ(viewerProblem(options), "") << address;
  }
  for (const char* address : {"", "localhost", "robot", "1.2.3", "1.2.3.4.5", "127.0.0.1:80"}) {
    options.address = address;
    EXPECT_NE(viewerProblem(options).find("is no address"), std::string::npos) << address;
  }
  options.address = "127.0.0.1";
  for (const std::string& token : {std::string("short"), std::string(129, 'a'), secret + " ", secret + "&"}) {
    options.token = token;
    EXPECT_NE(viewerProblem(options).find("viewer.token"), std::string::npos) << token;
  }
}

}  // namespace
}  // namespace edgeslam
