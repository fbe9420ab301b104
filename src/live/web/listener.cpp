// SPDX-License-Identifier: Apache-2.0
#include "web/listener.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <memory>
#include <system_error>

#include "kelpie/core/error.hpp"
#include "web/tuning.hpp"

namespace kelpie::web {
namespace {

using Addresses = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

Addresses addresses_of(const std::string& host, const char* port, const std::string& field) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_STREAM;
  wanted.ai_flags = AI_PASSIVE;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(host.c_str(), port, &wanted, &found); error != 0) {
    throw InputError(field, host + ": " + ::gai_strerror(error));
  }
  return {found, &::freeaddrinfo};
}

// A listening socket, or -1. With SO_REUSEPORT a second program would take every second request.
int listening(const addrinfo& at) {
  const int socket =
      ::socket(at.ai_family, at.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, at.ai_protocol);
  const int yes = 1;
  if (socket >= 0 &&
      (::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes)) != 0 ||
       ::bind(socket, at.ai_addr, at.ai_addrlen) != 0 || ::listen(socket, kTuning.backlog) != 0)) {
    const int error = errno;
    ::close(socket);
    errno = error;
    return -1;
  }
  return socket;
}

}  // namespace

int listen_at(const live::Endpoint& endpoint, const std::string& field) {
  const std::string port = std::to_string(endpoint.port);
  const Addresses addresses = addresses_of(endpoint.host, port.c_str(), field);
  for (const addrinfo* one = addresses.get(); one != nullptr; one = one->ai_next) {
    if (const int socket = listening(*one); socket >= 0) {
      return socket;
    }
  }
  throw InputError(field, fmt::format("cannot listen on {}:{}: {}", endpoint.host, port,
                                      std::generic_category().message(errno)));
}

bool is_loopback(const std::string& host, const std::string& field) {
  const Addresses addresses = addresses_of(host, nullptr, field);
  for (const addrinfo* one = addresses.get(); one != nullptr; one = one->ai_next) {
    const void* const address = one->ai_addr;
    const bool is_local =
        one->ai_family == AF_INET
            ? (ntohl(static_cast<const sockaddr_in*>(address)->sin_addr.s_addr) >> 24U) == 127
            : one->ai_family == AF_INET6 &&
                  IN6_IS_ADDR_LOOPBACK(&static_cast<const sockaddr_in6*>(address)->sin6_addr) != 0;
    if (!is_local) {
      return false;
    }
  }
  return true;
}

}  // namespace kelpie::web
