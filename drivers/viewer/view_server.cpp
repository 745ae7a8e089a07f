#include "drivers/viewer/view_server.h"

#include <boost/asio/ip/address.hpp>
#include <boost/system/system_error.hpp>
#include <random>
#include <utility>

#include "drivers/viewer/command_request.h"
#include "drivers/viewer/view_connection.h"
#include "drivers/viewer/viewer_page.h"
#include "edgeslam/input_error.h"

namespace edgeslam {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

constexpr auto usual_interval =
    std::chrono::seconds(1);  // of states where nothing changes: the page sees that it lives

std::string randomDigits() {
  std::random_device random;
  std::string digits;
  for (int i = 0; i < 32; ++i) digits.push_back("0123456789abcdef"[random() % 16]);
  return digits;
}

}  // namespace

ViewServer::ViewServer(const ViewerOptions& options, const ViewerSetup& setup, const ViewerPatience& patience,
                       ViewFeed& feed)
    : options_(options),
      setup_(setup),
      patience_(patience),
      feed_(feed),
      nonce_(randomDigits()),
      page_(viewerPage(nonce_)) {
  try {
    const tcp::endpoint endpoint(asio::ip::make_address(options.address), static_cast<unsigned short>(options.port));
    acceptor_.open(endpoint.protocol());
    acceptor_.set_option(tcp::acceptor::reuse_address(true));
    acceptor_.bind(endpoint);
    acceptor_.listen(static_cast<int>(most_connections));
    port_ = acceptor_.local_endpoint().port();
  } catch (const boost::system::system_error& error) {
    throw InputError("the viewer cannot listen on " + options.address + ", port " + std::to_string(options.port) +
                     " (viewer.address, viewer.port): " + error.code().message());
  }
  latest_[0] = std::make_shared<const std::string>(helloMessage(setup_));
}

// Who waits for an answer has a connection, which tells this server that it goes.
ViewServer::~ViewServer() { asked_.clear(); }

void ViewServer::run() {
  accept();
  context_.run();
}

void ViewServer::accept() {
  acceptor_.async_accept([this](const boost::system::error_code& error, tcp::socket socket) {
    if (!error) {
      serveConnection(std::move(socket), *this, connections_ >= most_connections);
      return accept();
    }
    // Out of file descriptors, most likely; the client waits in the queue.
    acceptance_.expires_after(std::chrono::seconds(1));
    acceptance_.async_wait([this](const boost::system::error_code& stopped) {
      if (!stopped) accept();
    });
  });
}

bool ViewServer::join(ViewStream& stream) {
  if (streams_.size() >= most_streams) return false;
  streams_.insert(&stream);
  for (std::size_t i = 0; i < latest_.size(); ++i) {
    if (latest_[i]) stream.offer(static_cast<ViewMessage>(i + 1), latest_[i]);
  }
  if (latest_map_) stream.offer(latest_map_);
  feed_.is_watched.store(true, std::memory_order_release);
  feed_.looks.ask();
  wake();
  return true;
}

void ViewServer::leave(ViewStream& stream) {
  streams_.erase(&stream);
  if (streams_.empty()) feed_.is_watched.store(false, std::memory_order_release);
}

void ViewServer::command(std::string_view body, TakeAnswer take) {
  const CommandRequest request = readCommandRequest(body, ++commands_);
  if (!request.command) return take(400, commandAnswerText(false, request.problem));
  Command* sent = asked_.size() < ViewFeed::most_commands ? feed_.commands.claim() : nullptr;
  if (!sent) return take(503, commandAnswerText(false, "too many commands at once; send it again"));
  *sent = *request.command;
  asked_[request.command->id] = {std::move(take), Clock::now() + longest_wait_for_answer};
  feed_.commands.send(sent);
  wake();
}

// Ticks as long as there is someone to tick for.
void ViewServer::wake() {
  if (std::exchange(is_awake_, true)) return;
  asio::post(context_, [this] { tick(); });
}

void ViewServer::tick() {
  takeAnswers();
  if (!streams_.empty()) {
    lookAtState();
    lookAtMap();
    lookAtPicture();
  }
  if (streams_.empty() && asked_.empty()) {
    is_awake_ = false;
    return;
  }
  timer_.expires_after(picture_interval);
  timer_.async_wait([this](const boost::system::error_code& stopped) {
    if (!stopped) tick();
  });
}

void ViewServer::takeAnswers() {
  while (ViewedAnswer* answer = feed_.answers.receive()) {
    const auto asked = asked_.find(answer->command);
    if (asked != asked_.end()) {
      const TakeAnswer take = std::move(asked->second.take);
      asked_.erase(asked);
      take(200, commandAnswerText(answer->accepted, answer->message));
    }
    feed_.answers.release(answer);
  }
  for (auto asked = asked_.begin(); asked != asked_.end();) {
    if (Clock::now() < asked->second.until) {
      ++asked;
      continue;
    }
    asked->second.take(504, commandAnswerText(false, "no answer yet; the command may still be carried out"));
    asked = asked_.erase(asked);
  }
}

void ViewServer::offer(ViewMessage kind, std::string message) {
  SharedMessage& latest = latest_[static_cast<std::size_t>(kind) - 1];
  latest = std::make_shared<const std::string>(std::move(message));
  for (ViewStream* stream : streams_) stream->offer(kind, latest);
}

void ViewServer::lookAtState() {
  std::vector<FrameSample> samples;
  FrameSample sample;
  while (feed_.samples.pop(sample)) samples.push_back(sample);
  const bool is_new = feed_.states.take();
  if (!is_new && samples.empty() && Clock::now() - state_told_ < usual_interval) return;
  state_told_ = Clock::now();
  offer(ViewMessage::state, stateMessage(feed_.states.reading(), samples));
}

void ViewServer::lookAtMap() {
  if (!feed_.maps.take()) return;
  const auto [map, world] = std::exchange(feed_.maps.reading(), {});
  if (!map) return;
  const std::int64_t number = latest_map_ ? latest_map_->number + 1 : 1;
  latest_map_ = std::make_shared<const ViewedMap>(viewedMap(*map, world, setup_.camera, number));
  for (ViewStream* stream : streams_) stream->offer(latest_map_);
}

// A picture is encoded where someone is ready for it.
void ViewServer::lookAtPicture() {
  bool is_wanted = false;
  for (const ViewStream* stream : streams_) is_wanted = is_wanted || stream->wantsPicture();
  if (!is_wanted) return;
  if (feed_.looks.take()) {
    if (std::string message = pictureMessage(feed_.looks.look()); !message.empty()) {
      offer(ViewMessage::picture, std::move(message));
    }
    feed_.looks.letGo();
  }
  feed_.looks.ask();
}

}  // namespace edgeslam
