// Serves the page and what it shows, all from memory, in the thread that runs it.
//
// By Boost.Beast (Debian's libboost-dev, which the project needs anyway): one thread waits for all connections at once,
// so that streams that stay open use up no pool of threads, as they would with a library of a thread a connection
// (cpp-httplib); head, body and time of a request are bounded before it is looked at; and a client that reads slowly is
// seen by its write, not by a blocked thread.
#pragma once

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "drivers/viewer/view_feed.h"
#include "drivers/viewer/viewed_map.h"
#include "drivers/viewer/viewer_options.h"

namespace edgeslam {

// A message, shared by all who get it; its first byte is its kind.
using SharedMessage = std::shared_ptr<const std::string>;

// A client that gets the stream. Takes the newest message of each kind when it is ready for another.
class ViewStream {
 public:
  virtual ~ViewStream() = default;
  virtual void offer(ViewMessage kind, const SharedMessage& message) = 0;
  // Gives the map to those who look on; they take what they do not have yet.
  virtual void offer(const SharedMap& map) = 0;
  // False while the latest picture still waits to be sent: it takes none now.
  virtual bool wantsPicture() const = 0;
};

// All functions are for the server's thread, but the constructor and stop().
class ViewServer {
 public:
  static constexpr std::size_t most_connections = 24;
  static constexpr std::size_t most_streams = 6;
  static constexpr auto picture_interval = std::chrono::milliseconds(100);
  static constexpr auto longest_wait_for_answer = std::chrono::seconds(10);

  // Listens. Throws InputError where it cannot.
  ViewServer(const ViewerOptions& options, const ViewerSetup& setup, const ViewerPatience& patience, ViewFeed& feed);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  // Until stop().
  void run();
  // From any thread.
  void stop() { context_.stop(); }
  // From any thread: the port, the one chosen where 0 was asked for.
  int port() const { return port_; }

  // For connections.
  using TakeAnswer = std::function<void(int status, const std::string& json)>;
  const ViewerOptions& options() const { return options_; }
  const ViewerPatience& patience() const { return patience_; }
  const std::string& page() const { return page_; }
  const std::string& scriptNonce() const { return nonce_; }
  // `take` is called once, with the answer or with what is in its place.
  void command(std::string_view body, TakeAnswer take);
  // False where there are too many.
  bool join(ViewStream& stream);
  void leave(ViewStream& stream);
  void countConnection(int change) { connections_ += static_cast<std::size_t>(change); }

 private:
  using Clock = std::chrono::steady_clock;
  struct Asked {
    TakeAnswer take;
    Clock::time_point until;
  };

  void accept();
  void wake();
  void tick();
  void takeAnswers();
  void lookAtState();
  void lookAtMap();
  void lookAtPicture();
  void offer(ViewMessage kind, std::string message);

  ViewerOptions options_;
  ViewerSetup setup_;
  ViewerPatience patience_;
  ViewFeed& feed_;
  int port_ = 0;
  std::string nonce_, page_;
  std::size_t connections_ = 0;
  std::set<ViewStream*> streams_;
  std::map<std::int64_t, Asked> asked_;  // by the command's number
  std::int64_t commands_ = 0;
  std::array<SharedMessage, view_messages> latest_;  // by kind, for those who join; none for the map
  SharedMap latest_map_;                             // likewise
  Clock::time_point state_told_{};
  bool is_awake_ = false;

  // Last: what connections leave behind when the context goes is above.
  boost::asio::io_context context_{1};
  boost::asio::ip::tcp::acceptor acceptor_{context_};
  boost::asio::steady_timer timer_{context_}, acceptance_{context_};
};

}  // namespace edgeslam
