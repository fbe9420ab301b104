// SPDX-License-Identifier: Apache-2.0
#include "autopilot/udp_line.hpp"

#include <netdb.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "kelpie/core/error.hpp"

namespace kelpie::autopilot {
namespace {

constexpr std::size_t kLongestDatagram = 65'536;

sockaddr* as_address(sockaddr_storage& storage) {
  return reinterpret_cast<sockaddr*>(&storage);  // NOLINT: as sockets want it
}

std::string reason() {
  return std::generic_category().message(errno);
}

}  // namespace

UdpLine::UdpLine(const Connection& connection)
    : listens_(connection.kind == Connection::Kind::udp_listen), buffer_(kLongestDatagram) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_DGRAM;
  wanted.ai_flags = listens_ ? AI_PASSIVE : 0;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(connection.host.c_str(), std::to_string(connection.port).c_str(),
                                  &wanted, &found);
  if (error != 0) {
    throw InputError(connection.host + ": " + ::gai_strerror(error));
  }
  Address address;
  std::memcpy(&address.storage, found->ai_addr, found->ai_addrlen);
  address.bytes = found->ai_addrlen;
  socket_ = ::socket(found->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  ::freeaddrinfo(found);
  if (socket_ < 0) {
    throw Failure("UDP: " + reason());
  }
  if (!listens_) {
    peer_ = address;
  } else if (::bind(socket_, as_address(address.storage), address.bytes) != 0) {
    const std::string why = reason();
    ::close(socket_);
    throw InputError("UDP port " + std::to_string(connection.port) + " of " + connection.host +
                     ": " + why);
  }
}

UdpLine::~UdpLine() {
  ::close(socket_);
}

std::span<const std::byte> UdpLine::read(std::chrono::milliseconds timeout) {
  pollfd ready{.fd = socket_, .events = POLLIN, .revents = 0};
  if (::poll(&ready, 1, static_cast<int>(timeout.count())) <= 0) {
    return {};
  }
  last_.bytes = sizeof(last_.storage);
  const ssize_t bytes = ::recvfrom(socket_, buffer_.data(), buffer_.size(), 0,
                                   as_address(last_.storage), &last_.bytes);
  return bytes > 0 ? std::span<const std::byte>(buffer_).first(static_cast<std::size_t>(bytes))
                   : std::span<const std::byte>();
}

void UdpLine::answer_last() {
  peer_ = listens_ ? last_ : peer_;
}

void UdpLine::write(std::span<const std::byte> bytes) {
  if (peer_.bytes > 0) {
    static_cast<void>(::sendto(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                               as_address(peer_.storage), peer_.bytes));
  }
}

std::uint16_t UdpLine::port() const {
  Address own;
  own.bytes = sizeof(own.storage);
  ::getsockname(socket_, as_address(own.storage), &own.bytes);
  const bool is_ip6 = own.storage.ss_family == AF_INET6;
  return ntohs(is_ip6 ? reinterpret_cast<sockaddr_in6&>(own.storage).sin6_port  // NOLINT: the
                      : reinterpret_cast<sockaddr_in&>(own.storage).sin_port);  // NOLINT: same
}

}  // namespace kelpie::autopilot
