// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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

/// A word by which a single number is known as a command: a column of a CSV file, a message of one
/// number, a field of a type that isn't known.
struct KnownWord {
  enum class Kind { thrust, angle, wrench };

  std::string word;  ///< in lower case; "rpm#": also rpm1, rpm2; "u_speed": the whole name
  Kind kind;         ///< two words of a kind for the same thrusters are two readings
  int rank;          ///< as a message's
  std::string_view why = {};
};

/// The messages: for each part of a topic the first that fits counts.
std::span<const KnownMessage> known_messages();
const std::vector<KnownWord>& known_command_words();
/// Words by which a name is no command, whatever else it holds: time stamps, currents, limits.
std::span<const std::string_view> known_other_words();
/// Fields of a thruster's message, the likeliest first.
std::span<const std::string_view> known_command_fields();
/// Columns of time, besides kTimeNames.
std::span<const std::string_view> known_times();

/// "a.{x,y,z}" as a.x, a.y, a.z; "c{1..3}" and "c[0..2]" alike.
std::vector<std::string> expanded(std::string_view fields);

/// A name's words in lower case, apart at what is neither letter nor digit and where small letters
/// end; without what is in brackets at its end: "ThrusterLeft/Cmd [V]" is thruster, left, cmd.
std::vector<std::string> words_of(std::string_view name);

/// The axis of a velocity by its name, 0 to 5 for u, v, w, p, q, r.
std::optional<std::size_t> velocity_by_name(std::string_view name);

}  // namespace kelpie::log
