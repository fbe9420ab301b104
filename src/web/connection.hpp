// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <httplib.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <string>

namespace kelpie::web {

/// A connection with limits, as cpp-httplib reads and writes it: a request may take so long and be
/// so large, no matter how slowly it comes. Closed at the end.
class Connection final : public httplib::Stream {
 public:
  static constexpr std::size_t kMostBytes = 16384;  ///< of a request
  static constexpr std::chrono::seconds kLongestRequest{10};
  static constexpr std::chrono::seconds kLongestWrite{5};  ///< that takes nothing

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

  bool wait_for(short events, Clock::time_point until) const;  // NOLINT: as poll() wants it

  int socket_;
  const std::atomic<bool>& stops_;
  Clock::time_point came_ = Clock::now();
  std::size_t read_ = 0;
};

}  // namespace kelpie::web
