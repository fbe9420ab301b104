// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kelpie::testing {

/// A TCP connection to a port of this machine. A receiver's buffer of some size, or the default.
class Peer {
 public:
  explicit Peer(std::uint16_t port, int buffer_bytes = 0)
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    if (buffer_bytes > 0) {
      ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &buffer_bytes, sizeof(buffer_bytes));
    }
    const timeval most{.tv_sec = 20, .tv_usec = 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &most, sizeof(most));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  }
  ~Peer() { ::close(socket_); }
  Peer(const Peer&) = delete;
  Peer(Peer&&) = delete;
  Peer& operator=(const Peer&) = delete;
  Peer& operator=(Peer&&) = delete;

  void send(std::string_view bytes) const {
    ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  void end() const { ::shutdown(socket_, SHUT_WR); }

  /// Appends what has come; false at the end of the connection, and after 20 s of silence.
  bool read(std::string& text) const {
    std::array<char, 16384> bytes{};
    const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
    text.append(bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    return count > 0;
  }

 private:
  int socket_;
};

/// An answer as it came, in pieces ("chunked") or whole.
struct Answered {
  int status = 0;  ///< 0: no answer
  std::string head{};
  std::string body{};

  std::string header(const std::string& name) const {
    const std::size_t at = head.find("\r\n" + name + ": ");
    const std::size_t begin = at + name.size() + 4;
    return at == std::string::npos ? "" : head.substr(begin, head.find("\r\n", begin) - begin);
  }
};

inline std::string unchunked(std::string_view body) {
  std::string text;
  for (std::size_t end = body.find("\r\n"); end != std::string_view::npos;
       end = body.find("\r\n")) {
    const std::size_t bytes = std::stoul(std::string(body.substr(0, end)), nullptr, 16);
    text += body.substr(end + 2, bytes);
    body.remove_prefix(std::min(body.size(), end + 2 + bytes + 2));
  }
  return text;
}

inline Answered answered(const std::string& text) {
  const std::size_t end = text.find("\r\n\r\n");
  if (!text.starts_with("HTTP/1.1 ") || end == std::string::npos) {
    return {};
  }
  Answered answer{.status = std::stoi(text.substr(9)), .head = text.substr(0, end + 2)};
  const std::string body = text.substr(end + 4);
  answer.body = answer.header("Transfer-Encoding") == "chunked" ? unchunked(body) : body;
  return answer;
}

/// A program that asks a server on this machine.
class Client {
 public:
  using Headers = std::vector<std::pair<std::string, std::string>>;
  using Enough = std::function<bool(const std::string& body)>;

  explicit Client(std::uint16_t port) : port_(port) {}

  Answered get(const std::string& path, const Headers& headers = {}) const {
    return ask("GET", path, headers);
  }
  Answered post(const std::string& path, const Headers& headers = {},
                const std::string& body = "") const {
    return ask("POST", path, headers, body);
  }
  /// Reads until the end, or until the body is `enough`.
  Answered ask(const std::string& method, const std::string& path, const Headers& headers = {},
               const std::string& body = "", const Enough& enough = {}) const {
    std::string text = method + " " + path + " HTTP/1.1\r\n";
    const auto is_host = [](const auto& header) { return header.first == "Host"; };
    if (std::ranges::none_of(headers, is_host)) {
      text += "Host: localhost:" + std::to_string(port_) + "\r\n";
    }
    for (const auto& [name, value] : headers) {
      text += name + ": " + value + "\r\n";
    }
    if (method == "POST") {
      text += "Content-Length: " + std::to_string(body.size()) + "\r\n";
    }
    const Peer peer(port_);
    peer.send(text + "\r\n" + body);
    std::string heard;
    while (peer.read(heard) && !(enough && enough(answered(heard).body))) {
    }
    return answered(heard);
  }

 private:
  std::uint16_t port_;
};

}  // namespace kelpie::testing
