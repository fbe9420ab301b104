// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "file/toml.hpp"

namespace kelpie::autopilot {

/// Where an autopilot is reached.
struct Connection {
  enum class Kind : std::uint8_t {
    udp_listen,  ///< whoever sends to this port is heard, and answered
    udp_send,    ///< to this host and port, from any port of ours
    serial,
  };

  Kind kind = Kind::udp_listen;
  std::string host = "127.0.0.1";  ///< to listen on or to send to
  std::uint16_t port = 14550;      ///< 0, listening: any that is free
  std::string device{};            ///< of a serial line
  unsigned baud = 0;               ///< bits/s

  bool operator==(const Connection&) const = default;
};

/// "udp:14550", "udp:0.0.0.0:14550", "udpout:192.168.2.2:14550", "serial:/dev/ttyACM0:115200".
/// Throws InputError on anything else, and on a baud rate that serial lines don't have.
Connection parse_connection(const std::string& text);

/// The table [live.mavlink] of a configuration file (docs/live.md).
struct LinkSettings {
  static constexpr std::uint8_t kOnboardComputer = 191;  // MAV_COMP_ID_ONBOARD_COMPUTER

  std::string text = "udp:14550";  ///< the connection, as written
  Connection connection{};
  std::uint8_t system = 0;     ///< of the vehicle; 0: the first autopilot that is heard
  std::uint8_t system_id = 0;  ///< ours; 0: the vehicle's, as its computer
  std::uint8_t component_id = kOnboardComputer;  ///< ours
  std::map<std::string, double> rates{};         ///< [Hz] that messages are asked for at

  bool operator==(const LinkSettings&) const = default;
};

/// What the table says. Throws InputError (file, line, key) on what it can't be.
LinkSettings read_link_settings(const file::TomlNode& table);

}  // namespace kelpie::autopilot
