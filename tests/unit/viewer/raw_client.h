// A client that sends bytes as they are, also those that no browser sends.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>
#include <string>

namespace edgeslam {

class RawClient {
 public:
  // On the loopback. `receive_buffer`: of the kernel [bytes]; 0: the usual.
  explicit RawClient(const std::string& address, int receive_buffer = 0) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    if (receive_buffer > 0) {
      setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof(receive_buffer));
    }
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port = htons(static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
    if (connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof(to)) != 0) {
      throw std::runtime_error("cannot connect to " + address);
    }
  }
  ~RawClient() { ::close(socket_); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  // As much as is taken.
  void send(const std::string& bytes) const {
    for (std::size_t at = 0; at < bytes.size();) {
      const ssize_t sent = ::send(socket_, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
      if (sent <= 0) return;
      at += static_cast<std::size_t>(sent);
    }
  }
  void endSending() const { shutdown(socket_, SHUT_WR); }

  // Until the other side ends, or `enough` bytes are there, or for so long.
  std::string receive(std::size_t enough = std::string::npos, int longest_ms = 20000) const {
    std::string received;
    char bytes[65536];
    while (received.size() < enough) {
      pollfd ready{socket_, POLLIN, 0};
      if (poll(&ready, 1, longest_ms) <= 0) break;
      const ssize_t count = recv(socket_, bytes, sizeof(bytes), 0);
      if (count <= 0) break;
      received.append(bytes, static_cast<std::size_t>(count));
    }
    return received;
  }

 private:
  int socket_;
};

}  // namespace edgeslam
