// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "autopilot/signing.hpp"
#include "file/toml.hpp"

namespace kelpie::autopilot {

/// Address of an autopilot.
struct Connection {
  enum class Kind : std::uint8_t {
    udp_listen,  ///< receive from any sender to `port`, and answer
    udp_send,    ///< send to `host` and `port`, from any own port
    serial,
  };

  Kind kind = Kind::udp_listen;
  std::string host = "127.0.0.1";  ///< to listen on or to send to
  std::uint16_t port = 14550;      ///< listening, 0: any free port
  std::string device{};            ///< of a serial line
  unsigned baud = 0;               ///< bits/s

  bool operator==(const Connection&) const = default;
};

/// Reads "udp:14550", "udp:0.0.0.0:14550", "udpout:192.168.2.2:14550" or
/// "serial:/dev/ttyACM0:115200". Throws InputError on other texts and unknown baud rates.
Connection parse_connection(const std::string& text);

/// How velocities are told to the autopilot.
enum class VelocityMessage : std::uint8_t {
  none,
  odometry,  ///< ODOMETRY
  delta,     ///< VISION_POSITION_DELTA, ArduSub's door for a velocity log
};

/// The table [live.mavlink] of a configuration file (docs/howto/live.md).
struct LinkSettings {
  static constexpr std::uint8_t kOnboardComputer = 191;  // MAV_COMP_ID_ONBOARD_COMPUTER

  std::string text = "udp:14550";  ///< the connection, as written
  Connection connection{};
  std::uint8_t system = 0;          ///< of the vehicle; 0: of the first autopilot with data
  std::uint8_t component = 0;       ///< the same
  std::optional<SigningKey> key{};  ///< given: only signed frames are heard and sent
  std::uint8_t system_id = 0;       ///< own; 0: the vehicle's
  std::uint8_t component_id = kOnboardComputer;  ///< own
  std::map<std::string, double> rates{};         ///< requested rates of messages [Hz]
  VelocityMessage velocity = VelocityMessage::none;
  bool is_frd = true;  ///< the log's velocities are forward, right, down; else forward, left, up

  bool operator==(const LinkSettings&) const = default;
};

/// Reads the table. Throws InputError (file, line, key) on invalid values.
LinkSettings read_link_settings(const file::TomlNode& table);

}  // namespace kelpie::autopilot
