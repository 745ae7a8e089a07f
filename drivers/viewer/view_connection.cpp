#include "drivers/viewer/view_connection.h"

#include <array>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <optional>
#include <utility>

#include "drivers/viewer/command_request.h"
#include "drivers/viewer/request_check.h"

namespace edgeslam {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;

constexpr auto linger_time = std::chrono::seconds(2);
constexpr int stream_buffer = 256 << 10;       // of the kernel, so that what waits there is not old [bytes]
constexpr std::size_t most_drained = 1 << 20;  // [bytes]
constexpr std::uint32_t largest_head = 8192, largest_body = 4096;  // [bytes]

// A refused person sees where to put the token.
std::string refusalPage(const Refusal& refusal) {
  std::string page =
      "<!DOCTYPE html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\"><meta name=\"color-scheme\" content=\"light dark\"><title>Edge SLAM</title>"
      "<body style=\"font:16px/1.5 system-ui,sans-serif;max-width:30em;margin:3em auto;padding:0 1em\"><h1>Edge "
      "SLAM</h1><p>" +
      refusal.message + ".</p>";
  if (refusal.status == 401) {
    page +=
        "<form method=\"get\" action=\"/\"><label>Token <input name=\"token\" type=\"password\" required autofocus "
        "autocomplete=\"off\"></label> <button>Open</button></form>";
  }
  return page;
}

class Connection : public ViewStream, public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, ViewServer& server)
      : stream_(std::move(socket)), server_(server), deadline_(stream_.get_executor()) {
    server_.countConnection(1);
  }
  ~Connection() override {
    server_.leave(*this);
    server_.countConnection(-1);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void read();
  void refuse(const Refusal& refusal, bool is_page);

  void offer(ViewMessage kind, const SharedMessage& message) override;
  void offer(const SharedMap& map) override;
  bool wantsPicture() const override { return !waiting_[indexOf(ViewMessage::picture)]; }

 private:
  static std::size_t indexOf(ViewMessage kind) { return static_cast<std::size_t>(kind) - 1; }

  void haveRequest(const beast::error_code& error);
  void serve();
  void respond(int status, const std::string& type, std::string body);
  void linger();
  void drain();
  void beginStream();
  void watchForEnd();
  void sendNext();
  SharedMessage nextMessage();
  void end();

  beast::tcp_stream stream_;
  ViewServer& server_;
  asio::steady_timer deadline_;  // of a message in a stream
  beast::flat_buffer buffer_;
  http::request_parser<http::string_body> parser_;
  http::response<http::string_body> response_;
  std::size_t drained_ = 0;

  // Of a stream.
  http::response<http::empty_body> head_;
  std::optional<http::response_serializer<http::empty_body>> head_serializer_;
  std::array<SharedMessage, view_messages> waiting_;
  SharedMap waiting_map_, sent_map_;
  std::string frame_;  // being sent: length and message
  bool is_sending_ = true, has_ended_ = false;
  std::array<char, 256> unwanted_{};
};

void Connection::read() {
  parser_.header_limit(largest_head);
  parser_.body_limit(largest_body);
  stream_.expires_after(server_.patience().request);
  http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](const beast::error_code& error, std::size_t) {
    self->haveRequest(error);
  });
}

void Connection::haveRequest(const beast::error_code& error) {
  if (!error) return serve();
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return refuse({431, "the request's head is too large"}, false);
  }
  if (error == http::error::body_limit) return refuse({413, "the request's body is too large"}, false);
  // Otherwise the client went away, or took too long: the connection is closed already.
  if (error.category() == make_error_code(http::error::bad_method).category() && error != http::error::end_of_stream) {
    return refuse({400, "this is no HTTP request: " + error.message()}, false);
  }
}

void Connection::serve() {
  const http::request<http::string_body>& request = parser_.get();
  const auto text = [](beast::string_view view) { return std::string_view(view.data(), view.size()); };
  const auto field = [&](http::field name) { return text(request[name]); };
  RequestHead head;
  head.method = text(request.method_string());
  head.target = text(request.target());
  head.host = field(http::field::host);
  head.origin = field(http::field::origin);
  head.authorization = field(http::field::authorization);
  head.content_type = field(http::field::content_type);
  head.fetch_site = text(request["Sec-Fetch-Site"]);
  for (const http::field name :
       {http::field::host, http::field::origin, http::field::authorization, http::field::content_type}) {
    head.has_repeated_fields = head.has_repeated_fields || request.count(name) > 1;
  }
  const RequestVerdict verdict = checkRequest(head, server_.options());
  if (verdict.refusal) return refuse(*verdict.refusal, head.target.substr(0, head.target.find('?')) == "/");
  switch (verdict.route) {
    case ViewerRoute::page:
      return respond(200, "text/html; charset=utf-8", server_.page());
    case ViewerRoute::stream:
      return beginStream();
    case ViewerRoute::command:
      stream_.expires_never();
      return server_.command(request.body(), [self = shared_from_this()](int status, const std::string& json) {
        self->respond(status, "application/json", json);
      });
  }
}

void Connection::refuse(const Refusal& refusal, bool is_page) {
  if (is_page) return respond(refusal.status, "text/html; charset=utf-8", refusalPage(refusal));
  respond(refusal.status, "application/json", commandAnswerText(false, refusal.message));
}

void Connection::respond(int status, const std::string& type, std::string body) {
  response_.result(static_cast<unsigned>(status));
  response_.version(11);
  response_.keep_alive(false);
  response_.set(http::field::content_type, type);
  response_.set(http::field::cache_control, "no-store");
  response_.set("X-Content-Type-Options", "nosniff");
  response_.set("X-Frame-Options", "DENY");
  response_.set("Referrer-Policy", "no-referrer");
  response_.set("Content-Security-Policy",
                "default-src 'none'; script-src 'nonce-" + server_.scriptNonce() +
                    "'; style-src 'unsafe-inline'; img-src blob: data:; connect-src 'self'; form-action 'self'; "
                    "base-uri 'none'; frame-ancestors 'none'");
  if (status == 401) response_.set(http::field::www_authenticate, "Bearer");
  response_.body() = std::move(body);
  response_.prepare_payload();
  stream_.expires_after(server_.patience().response);
  http::async_write(stream_, response_, [self = shared_from_this()](const beast::error_code& error, std::size_t) {
    if (!error) self->linger();
  });
}

// What the client still sends is read for a while: closing at once would take the answer away from it.
void Connection::linger() {
  beast::error_code ignored;
  stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  stream_.expires_after(linger_time);
  drain();
}

void Connection::drain() {
  stream_.async_read_some(asio::buffer(unwanted_),
                          [self = shared_from_this()](const beast::error_code& error, std::size_t bytes) {
                            self->drained_ += bytes;
                            if (!error && self->drained_ < most_drained) self->drain();
                          });
}

void Connection::beginStream() {
  stream_.expires_never();
  if (!server_.join(*this)) return refuse({503, "too many pages are open already"}, false);
  head_.result(http::status::ok);
  head_.version(11);
  head_.keep_alive(false);
  head_.chunked(true);
  head_.set(http::field::content_type, "application/octet-stream");
  head_.set(http::field::cache_control, "no-store");
  head_.set("X-Content-Type-Options", "nosniff");
  head_serializer_.emplace(head_);
  beast::error_code ignored;
  stream_.socket().set_option(tcp::socket::send_buffer_size(stream_buffer), ignored);
  watchForEnd();
  deadline_.expires_after(server_.patience().message);
  deadline_.async_wait([self = shared_from_this()](const beast::error_code& error) {
    if (!error) self->end();
  });
  http::async_write_header(stream_.socket(), *head_serializer_,
                           [self = shared_from_this()](const beast::error_code& error, std::size_t) {
                             if (error) return self->end();
                             self->is_sending_ = false;
                             self->sendNext();
                           });
}

// A client has nothing to say in a stream; that it went away is noticed here even while there is nothing to send.
void Connection::watchForEnd() {
  stream_.socket().async_read_some(asio::buffer(unwanted_),
                                   [self = shared_from_this()](const beast::error_code& error, std::size_t bytes) {
                                     self->drained_ += bytes;
                                     if (error || self->drained_ > most_drained) return self->end();
                                     self->watchForEnd();
                                   });
}

void Connection::offer(ViewMessage kind, const SharedMessage& message) {
  waiting_[indexOf(kind)] = message;
  if (!is_sending_) sendNext();
}

void Connection::offer(const SharedMap& map) {
  waiting_map_ = map;
  if (!is_sending_) sendNext();
}

// In the order of their kinds: pictures, which are the largest, last.
SharedMessage Connection::nextMessage() {
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    if (waiting_[i]) return std::exchange(waiting_[i], nullptr);
    if (i != indexOf(ViewMessage::map) || !waiting_map_) continue;
    const auto message = std::make_shared<const std::string>(mapMessage(*waiting_map_, sent_map_.get()));
    sent_map_ = std::exchange(waiting_map_, nullptr);
    return message;
  }
  return nullptr;
}

void Connection::sendNext() {
  deadline_.cancel();
  if (has_ended_) return;
  const SharedMessage message = nextMessage();
  if (!message) return;
  is_sending_ = true;
  frame_.clear();
  for (int i = 0; i < 4; ++i) frame_.push_back(static_cast<char>(message->size() >> (8 * i) & 0xFF));
  frame_ += *message;
  deadline_.expires_after(server_.patience().message);
  deadline_.async_wait([self = shared_from_this()](const beast::error_code& error) {
    if (!error) self->end();
  });
  asio::async_write(stream_.socket(), http::make_chunk(asio::buffer(frame_)),
                    [self = shared_from_this()](const beast::error_code& error, std::size_t) {
                      if (error) return self->end();
                      self->is_sending_ = false;
                      self->sendNext();
                    });
}

void Connection::end() {
  if (std::exchange(has_ended_, true)) return;
  is_sending_ = true;  // nothing more is begun
  deadline_.cancel();
  server_.leave(*this);
  beast::error_code ignored;
  stream_.socket().close(ignored);
}

}  // namespace

void serveConnection(tcp::socket socket, ViewServer& server, bool is_full) {
  const auto connection = std::make_shared<Connection>(std::move(socket), server);
  if (is_full) return connection->refuse({503, "too many connections"}, false);
  connection->read();
}

}  // namespace edgeslam
