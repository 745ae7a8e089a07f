// The server itself, on real sockets: what it serves, and what strangers can do to it.
#include "drivers/viewer/viewer.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <thread>

#include "unit/lcm/comes_true.h"
#include "unit/lcm/made_frames.h"
#include "unit/map/made_map.h"
#include "unit/viewer/raw_client.h"

namespace edgeslam {
namespace {

ViewerOptions anyPort(const std::string& token = "") {
  ViewerOptions options;
  options.enabled = true;
  options.port = 0;
  options.token = token;
  return options;
}

ViewerSetup smallSetup() {
  ViewerSetup setup;
  setup.version = "1.2.3";
  setup.source = "a \"camera\"";
  setup.camera = test::madeMap(64, 48).camera;
  setup.commands = {"reset"};
  return setup;
}

std::string get(const std::string& target, const std::string& more = "") {
  return "GET " + target + " HTTP/1.1\r\nHost: localhost\r\n" + more + "\r\n";
}

std::string post(const std::string& body, const std::string& more = "Content-Type: application/json\r\n") {
  return "POST /command HTTP/1.1\r\nHost: localhost\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" + more +
         "\r\n" + body;
}

// 0: no answer of HTTP.
int statusOf(const std::string& answer) {
  return answer.rfind("HTTP/1.1 ", 0) == 0 ? std::stoi(answer.substr(9, 3)) : 0;
}

std::string ask(const Viewer& viewer, const std::string& request) {
  const RawClient client(viewer.address());
  client.send(request);
  return client.receive();
}

TEST(Viewer, ThePageIsWholeAndAsksForNothingElsewhere) {
  const Viewer viewer(anyPort(), smallSetup());
  const std::string page = ask(viewer, get("/"));
  EXPECT_EQ(statusOf(page), 200);
  EXPECT_NE(page.find("Content-Security-Policy: default-src 'none'; script-src 'nonce-"), std::string::npos);
  EXPECT_NE(page.find("THREE"), std::string::npos);
  EXPECT_NE(page.find("followStream("), std::string::npos);
  EXPECT_NE(page.find("</html>"), std::string::npos);
  EXPECT_EQ(page.find("{{"), page.npos) << page.substr(page.find("{{"), 60);
  for (const char* elsewhere : {"src=\"http", "href=\"http", "@import", "url(http"}) {
    EXPECT_EQ(page.find(elsewhere), std::string::npos) << elsewhere;
  }
  EXPECT_FALSE(viewer.isWatched()) << "a page that is only read watches nothing";
}

TEST(Viewer, TheStreamBringsWhatIsShownAndNobodyIsServedUnwatched) {
  Viewer viewer(anyPort(), smallSetup());
  viewer.frame(measuredFrame(1, Pose()));
  {
    const RawClient client(viewer.address());
    client.send(get("/stream"));
    ASSERT_TRUE(comesTrue([&] { return viewer.isWatched(); }));
    viewer.frame(measuredFrame(2, Pose()));
    viewer.map(std::make_shared<Map>(test::madeMap(64, 48).map), 0);
    viewer.status({}, {}, "the network is down");
    std::string received;
    EXPECT_TRUE(comesTrue([&] {
      received += client.receive(1, 1000);
      return received.find("the network is down") != std::string::npos &&
             received.find("points_in_map") != std::string::npos;
    })) << received;
    EXPECT_NE(received.find("Transfer-Encoding: chunked"), std::string::npos);
    EXPECT_NE(received.find("1.2.3"), std::string::npos);
    EXPECT_NE(received.find("\"index\":2"), std::string::npos);
  }
  EXPECT_TRUE(comesTrue([&] { return !viewer.isWatched(); })) << "a closed page is noticed";
}

TEST(Viewer, ACommandIsHandedOutOnceAndItsAnswerGivenBack) {
  Viewer viewer(anyPort(), smallSetup());
  const RawClient client(viewer.address());
  client.send(post(R"({"command": "reset"})"));
  std::optional<Command> command;
  ASSERT_TRUE(comesTrue([&] { return (command = viewer.nextCommand()).has_value(); }));
  EXPECT_EQ(command->kind, CommandKind::reset);
  EXPECT_EQ(command->sender, CommandSender::viewer);
  EXPECT_FALSE(viewer.nextCommand());
  viewer.answer(*command, true, "begun anew");
  const std::string answer = client.receive();
  EXPECT_EQ(statusOf(answer), 200);
  EXPECT_NE(answer.find(R"({"accepted":true,"message":"begun anew"})"), std::string::npos) << answer;
}

TEST(Viewer, CommandsThatNobodyTakesAreBounded) {
  Viewer viewer(anyPort(), smallSetup());
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 8; ++i) {
    clients.push_back(std::make_unique<RawClient>(viewer.address()));
    clients.back()->send(post(R"({"command": "reset"})"));
  }
  EXPECT_TRUE(comesTrue([&] { return statusOf(ask(viewer, get("/nothing"))) == 404; }));
  std::string answer;
  EXPECT_TRUE(comesTrue([&] {
    const RawClient more(viewer.address());
    more.send(post(R"({"command": "reset"})"));
    answer = more.receive(std::string::npos, 300);
    return statusOf(answer) == 503;
  })) << answer;
}

TEST(Viewer, HostileRequestsAreRefusedAndItGoesOn) {
  ViewerPatience patience;
  patience.request = std::chrono::milliseconds(200);
  Viewer viewer(anyPort(), smallSetup(), patience);
  const std::string json = "Content-Type: application/json\r\n";
  struct Case {
    std::string request;
    int status;
  };
  const Case cases[] = {
      {"\r\n\r\n", 400},
      {std::string(3000, '\0'), 400},
      {"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 400},  // TLS
      {"GET\r\n\r\n", 400},
      {"GET / HTTP/9.9\r\nHost: localhost\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\nHost localhost\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: -1\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999999999999999\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\n\r\n", 400},                                        // no Host
      {"GET / HTTP/1.1\r\nHost: localhost\r\nHost: localhost\r\n\r\n", 400},  // two
      {"GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n", 403},                  // DNS rebinding
      {get("/", "Origin: http://evil.example\r\n"), 403},                     //
      {get("/../../../etc/passwd"), 404},                                     // no path names a file
      {get("/%2e%2e/%2e%2e/etc/passwd"), 404},                                //
      {get("/page.html"), 404},                                               //
      {get("/" + std::string(2000, 'a')), 414},                               //
      {get("/" + std::string(20000, 'a')), 431},                              //
      {get("/", "X: " + std::string(20000, 'a') + "\r\n"), 431},              //
      {post("{}", "X-None: 1\r\n"), 415},                                     //
      {post("{}", json + "Origin: null\r\n"), 403},                           //
      {post("{}", json + "Sec-Fetch-Site: cross-site\r\n"), 403},             //
      {post("{", json), 400},                                                 //
      {post(R"({"command":"set_scale","from_utime":1,"to_utime":2,"distance_m":NaN})", json), 400},
      {post(std::string(5000, ' '), json), 413},
      {"POST /command HTTP/1.1\r\nHost: localhost\r\n" + json + "Content-Length: 4000000000\r\n\r\n", 413},
      {"POST /command HTTP/1.1\r\nHost: localhost\r\n" + json + "Transfer-Encoding: chunked\r\n\r\n" + "5000\r\n" +
           std::string(0x5000, ' ') + "\r\n0\r\n\r\n",
       413},
      {"POST /command HTTP/1.1\r\nHost: localhost\r\n" + json + "Transfer-Encoding: chunked\r\n\r\nzz\r\n", 400},
      {"DELETE /command HTTP/1.1\r\nHost: localhost\r\n\r\n", 405},
      {"OPTIONS /command HTTP/1.1\r\nHost: localhost\r\nOrigin: http://evil.example\r\n\r\n", 405},
      // What never comes to its end: the server's patience does, and the connection is closed.
      {"GET / HTTP/1.1\r\nHost: loc", 0},
      {"POST /command HTTP/1.1\r\nHost: localhost\r\n" + json + "Content-Length: 20\r\n\r\n{", 0},
  };
  for (const Case& hostile : cases) {
    const std::string answer = ask(viewer, hostile.request);
    EXPECT_EQ(statusOf(answer), hostile.status) << hostile.request.substr(0, 200) << "\n -> " << answer.substr(0, 400);
    EXPECT_EQ(answer.find("root:"), std::string::npos);
  }
  for (const Case& hostile : cases) {  // cut short
    const RawClient client(viewer.address());
    client.send(hostile.request.substr(0, hostile.request.size() / 2));
    client.endSending();
    client.receive();
  }
  EXPECT_FALSE(viewer.nextCommand()) << "none of them commands";
  EXPECT_EQ(statusOf(ask(viewer, get("/"))), 200) << "it goes on";
}

TEST(Viewer, WithATokenStrangersSeeNothing) {
  Viewer viewer(anyPort("0123456789abcdef"), smallSetup());
  for (const std::string& request : {get("/"), get("/stream"), post(R"({"command": "reset"})"), get("/nothing"),
                                     get("/?token=0123456789abcdeg"), get("/stream?token=0123456789abcdef")}) {
    const std::string answer = ask(viewer, request);
    EXPECT_EQ(statusOf(answer), 401) << request;
    EXPECT_EQ(answer.find("0123456789abcdef"), std::string::npos);
    EXPECT_EQ(answer.find("THREE"), std::string::npos);
  }
  EXPECT_FALSE(viewer.nextCommand());
  EXPECT_EQ(statusOf(ask(viewer, get("/?token=0123456789abcdef"))), 200);
  const RawClient client(viewer.address());
  client.send(get("/stream", "Authorization: Bearer 0123456789abcdef\r\n"));
  EXPECT_TRUE(comesTrue([&] { return viewer.isWatched(); }));
}

TEST(Viewer, AClientThatDoesNotReadIsDroppedAndHoldsNobodyUp) {
  ViewerPatience patience;
  patience.message = std::chrono::milliseconds(300);
  Viewer viewer(anyPort(), smallSetup(), patience);
  const RawClient slow(viewer.address(), 4096);
  slow.send(get("/stream"));
  ASSERT_TRUE(comesTrue([&] { return viewer.isWatched(); }));
  Map map = test::madeMap(64, 48).map;
  MapPoint point = map.points.begin()->second;
  point.inverse_depth = 0.5;
  // Two that have no point in common: each is sent whole.
  std::array<std::shared_ptr<const Map>, 2> large;
  for (std::size_t i = 0; i < large.size(); ++i) {
    for (PointId id = 0; id < 20000; ++id) {
      point.id = id;
      point.inverse_depth = 0.5 + static_cast<double>(i);
      map.points[id] = point;
    }
    large[i] = std::make_shared<const Map>(map);
  }
  std::size_t shown = 0;
  std::chrono::duration<double> longest{0};
  EXPECT_TRUE(comesTrue([&] {
    const auto start = std::chrono::steady_clock::now();
    viewer.map(large[shown++ % 2], 0);
    viewer.frame(measuredFrame(1, Pose()));
    longest = std::max<std::chrono::duration<double>>(longest, std::chrono::steady_clock::now() - start);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return !viewer.isWatched();
  }));
  EXPECT_LT(longest.count(), 1) << "publishing waits for no client";
}

TEST(Viewer, ConnectionsAndStreamsAreBounded) {
  Viewer viewer(anyPort(), smallSetup());
  std::vector<std::unique_ptr<RawClient>> streams;
  for (int i = 0; i < 6; ++i) {
    streams.push_back(std::make_unique<RawClient>(viewer.address()));
    streams.back()->send(get("/stream"));
    EXPECT_EQ(statusOf(streams.back()->receive(12)), 200) << i;
  }
  EXPECT_EQ(statusOf(ask(viewer, get("/stream"))), 503);
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int i = 0; i < 40; ++i) idle.push_back(std::make_unique<RawClient>(viewer.address()));
  EXPECT_EQ(statusOf(idle.back()->receive()), 503) << "too many connections are told so";
  idle.clear();
  EXPECT_TRUE(comesTrue([&] { return statusOf(ask(viewer, get("/"))) == 200; })) << "room again";
  EXPECT_GT(streams.front()->receive(100).size(), 0U) << "streams go on";
}

TEST(Viewer, APortThatIsTakenIsTold) {
  const Viewer first(anyPort(), smallSetup());
  ViewerOptions options = anyPort();
  options.port = std::stoi(first.address().substr(first.address().rfind(':') + 1));
  try {
    const Viewer second(options, smallSetup());
    FAIL() << "two listen on one port";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("viewer.port"), std::string::npos) << error.what();
  }
}

TEST(Viewer, ItEndsWhateverItsClientsDo) {
  auto viewer = std::make_unique<Viewer>(anyPort(), smallSetup());
  const RawClient idle(viewer->address()), stream(viewer->address()), asking(viewer->address());
  idle.send("GET / HT");
  stream.send(get("/stream"));
  asking.send(post(R"({"command": "reset"})"));
  ASSERT_TRUE(comesTrue([&] { return viewer->isWatched() && viewer->nextCommand(); }));
  viewer.reset();
  EXPECT_EQ(idle.receive(), "") << "closed";
}

}  // namespace
}  // namespace edgeslam
