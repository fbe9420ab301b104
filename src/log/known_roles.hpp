// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace kelpie::log {

/// What a signal can be to a log of a vehicle.
enum class Part {
  velocity,    ///< three numbers, along x, y and z
  rates,       ///< about x, y and z
  angles,      ///< roll, pitch and yaw
  quaternion,  ///< of the attitude: w, x, y, z
  commands,    ///< of thrusters and fins, any number
};

/// A type of messages of which it is known what its fields are. known_roles.cpp has them all: who
/// knows one more adds a line.
struct KnownMessage {
  std::string_view type;   ///< "nav_msgs/Odometry" (without "/msg"), "ATTITUDE"
  std::string_view topic;  ///< what the topic's name has to hold, in lower case; "": any
  Part part;
  std::string_view fields;  ///< "twist.linear.{x,y,z}", "servo{1..8}_raw", "velocity[0..15]"
  std::string_view frame;   ///< FLU, FRD, ENU or NED; of an attitude: what it is seen from; "": –
  int rank;                 ///< the least is taken; what has one rank is as likely
  std::string_view why;     ///< for people: beside the line that is written
};

/// The messages: for each part of a topic the first that fits counts.
std::span<const KnownMessage> known_messages();
/// Words by which a name is no command, whatever else it holds: time stamps, currents, limits.
std::span<const std::string_view> known_other_words();
/// Fields of a thruster's message, the likeliest first.
std::span<const std::string_view> known_command_fields();
/// Columns of time, besides kTimeNames.
std::span<const std::string_view> known_times();

}  // namespace kelpie::log
