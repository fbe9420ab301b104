// SPDX-License-Identifier: Apache-2.0
#include "web/connection.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>

namespace kelpie::web {
namespace {

constexpr int kSliceMs = 100;  // after which it looks whether it has to stop

}  // namespace

Connection::~Connection() {
  ::shutdown(socket_, SHUT_RDWR);
  ::close(socket_);
}

ssize_t Connection::read(char* to, std::size_t size) {
  const std::size_t most = std::min(size, kMostBytes - read_);
  if (most == 0 || !wait_for(POLLIN, came_ + kLongestRequest)) {
    return -1;
  }
  const ssize_t count = ::recv(socket_, to, most, MSG_DONTWAIT);
  read_ += count > 0 ? static_cast<std::size_t>(count) : 0;
  return count;
}

ssize_t Connection::write(const char* from, std::size_t size) {
  return wait_for(POLLOUT, Clock::now() + kLongestWrite)
             ? ::send(socket_, from, size, MSG_DONTWAIT | MSG_NOSIGNAL)
             : -1;
}

bool Connection::wait_for(short events, Clock::time_point until) const {  // NOLINT
  while (!stops_ && Clock::now() < until) {
    pollfd one{.fd = socket_, .events = events, .revents = 0};
    const int ready = ::poll(&one, 1, kSliceMs);
    if (ready != 0) {
      return ready > 0;
    }
  }
  return false;
}

}  // namespace kelpie::web
