// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "autopilot/byte_line.hpp"

namespace kelpie::autopilot {

/// Datagrams over UDP.
class UdpLine final : public ByteLine {
 public:
  explicit UdpLine(const Connection& connection);
  ~UdpLine() override;
  UdpLine(const UdpLine&) = delete;
  UdpLine& operator=(const UdpLine&) = delete;

  std::span<const std::byte> read(std::chrono::milliseconds timeout) override;
  void write(std::span<const std::byte> bytes) override;
  void answer_last() override;

  std::uint16_t port() const;  ///< The own port.

 private:
  struct Address {
    sockaddr_storage storage{};
    socklen_t bytes = 0;
  };

  int socket_ = -1;
  bool listens_;
  Address peer_;  // target of write(); no bytes: not known yet
  Address last_;  // sender of the bytes read last
  std::vector<std::byte> buffer_;
};

}  // namespace kelpie::autopilot
