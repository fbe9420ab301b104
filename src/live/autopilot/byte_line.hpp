// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "autopilot/link_settings.hpp"
#include "file/descriptor.hpp"

namespace kelpie::autopilot {

/// Address of a sender of datagrams; a serial line's is empty.
struct Address {
  sockaddr_storage storage{};
  socklen_t bytes = 0;

  bool operator==(const Address& other) const;
  std::string text() const;  ///< "127.0.0.1:14550"
};

/// Bytes from and to an autopilot. For one thread.
class ByteLine {
 public:
  ByteLine() = default;
  virtual ~ByteLine() = default;
  ByteLine(const ByteLine&) = delete;
  ByteLine& operator=(const ByteLine&) = delete;

  /// Received bytes, after a wait of at most `timeout`; valid until the next call.
  virtual std::span<const std::byte> read(std::chrono::milliseconds timeout) = 0;

  /// Never waits: bytes that the line refuses now are lost.
  virtual void write(std::span<const std::byte> bytes) = 0;

  /// Sender of the bytes read last.
  virtual Address source() const { return {}; }

  /// Directs write() to an address, where several senders are possible.
  virtual void answer(const Address& /*to*/) {}

  /// Why nothing can be received now; empty: no fault.
  virtual std::string fault() const { return {}; }
};

/// Datagrams over UDP.
class UdpLine final : public ByteLine {
 public:
  explicit UdpLine(const Connection& connection);
  ~UdpLine() override;
  UdpLine(const UdpLine&) = delete;
  UdpLine& operator=(const UdpLine&) = delete;

  std::span<const std::byte> read(std::chrono::milliseconds timeout) override;
  void write(std::span<const std::byte> bytes) override;
  Address source() const override { return last_; }
  void answer(const Address& to) override;

  std::uint16_t port() const;  ///< The own port.

 private:
  int socket_ = -1;
  bool listens_;
  Address peer_;  // target of write(); no bytes: not known yet
  Address last_;  // sender of the bytes read last
  std::vector<std::byte> buffer_;
};

/// A serial line, 8N1. An unplugged line is opened again once plugged in.
class SerialLine final : public ByteLine {
 public:
  explicit SerialLine(const Connection& connection);

  std::span<const std::byte> read(std::chrono::milliseconds timeout) override;
  void write(std::span<const std::byte> bytes) override;
  std::string fault() const override;

 private:
  using Clock = std::chrono::steady_clock;

  std::string open();  // the error, or ""
  void lose();

  Connection connection_;
  std::unique_ptr<file::Descriptor> line_;  // null: unplugged
  Clock::time_point tried_;
  std::vector<std::byte> buffer_;
};

/// Opens a connection. Throws InputError on an unknown host, a port in use, a missing device or
/// missing permission.
std::unique_ptr<ByteLine> open_line(const Connection& connection);

bool is_baud_rate(unsigned bits_per_s);
std::string baud_rates_text();  ///< All valid rates.

}  // namespace kelpie::autopilot
