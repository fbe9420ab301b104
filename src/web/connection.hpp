// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <httplib.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <string>

namespace kelpie::web {

/// A connection for cpp-httplib with limits on a request's size and duration (Tuning). The
/// destructor closes the socket.
class Connection final : public httplib::Stream {
 public:
  /// Gives up soon after `stops` becomes true.
  Connection(int socket, const std::atomic<bool>& stops) : socket_(socket), stops_(stops) {}
  ~Connection() override;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool is_readable() const override { return true; }
  bool is_writable() const override { return !stops_; }
  ssize_t read(char* to, std::size_t size) override;
  ssize_t write(const char* from, std::size_t size) override;
  void get_remote_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  void get_local_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  socket_t socket() const override { return socket_; }

 private:
  using Clock = std::chrono::steady_clock;

  bool wait_for(short events, Clock::time_point until) const;  // NOLINT: poll()'s type

  int socket_;
  const std::atomic<bool>& stops_;
  Clock::time_point came_ = Clock::now();
  std::size_t read_ = 0;
};

}  // namespace kelpie::web
