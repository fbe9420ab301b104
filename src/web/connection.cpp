// SPDX-License-Identifier: Apache-2.0
#include "web/connection.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>

#include "web/tuning.hpp"

namespace kelpie::web {
Connection::~Connection() {
  ::shutdown(socket_, SHUT_RDWR);
  ::close(socket_);
}

ssize_t Connection::read(char* to, std::size_t size) {
  const std::size_t most = std::min(size, kTuning.request_bytes - read_);
  if (most == 0 || !wait_for(POLLIN, came_ + kTuning.longest_request)) {
    return -1;
  }
  const ssize_t count = ::recv(socket_, to, most, MSG_DONTWAIT);
  read_ += count > 0 ? static_cast<std::size_t>(count) : 0;
  return count;
}

ssize_t Connection::write(const char* from, std::size_t size) {
  return wait_for(POLLOUT, Clock::now() + kTuning.longest_write)
             ? ::send(socket_, from, size, MSG_DONTWAIT | MSG_NOSIGNAL)
             : -1;
}

bool Connection::wait_for(short events, Clock::time_point until) const {  // NOLINT
  while (!stops_ && Clock::now() < until) {
    pollfd one{.fd = socket_, .events = events, .revents = 0};
    const int ready = ::poll(&one, 1, static_cast<int>(kTuning.stop_check.count()));
    if (ready != 0) {
      return ready > 0;
    }
  }
  return false;
}

}  // namespace kelpie::web
