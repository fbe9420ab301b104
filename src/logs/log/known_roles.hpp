// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kelpie::log {

/// Part of a vehicle's motion that a signal measures.
enum class Part {
  velocity,    ///< three numbers, along x, y and z
  rates,       ///< about x, y and z
  angles,      ///< roll, pitch and yaw
  quaternion,  ///< of the attitude: w, x, y, z
  commands,    ///< of thrusters and fins, any number
  voltage,     ///< of the battery
};

/// A type of messages with known fields. known_roles.cpp has the table; a new type is a new line.
struct KnownMessage {
  std::string_view type;   ///< "nav_msgs/Odometry" (without "/msg"), "ATTITUDE"
  std::string_view topic;  ///< required part of the topic's name, in lower case; "": any name
  Part part;
  std::string_view fields;  ///< "twist.linear.{x,y,z}", "servo{1..16}_raw", "velocity[0..15]"
  std::string_view
      frame;             ///< FLU, FRD, ENU or NED; of an attitude: the reference frame; "": unknown
  int rank;              ///< the least rank is taken; equal ranks are equally likely
  std::string_view why;  ///< reason, written beside the line of the draft
};

/// Words that mark a single number as a command: a column of a CSV file, a message of one number, a
/// field of an unknown type.
struct CommandWords {
  enum class Kind { thrust, angle, wrench };

  std::string_view words;  ///< in lower case; "rpm#": also rpm1, rpm2; "u_speed": the whole name
  Kind kind;               ///< two words of a kind for the same thrusters are two readings
  int rank;                ///< as a message's
  std::string_view why = {};
  bool is_weak = false;  ///< tells that somebody commands something, not that an actuator does
};

/// The known messages: of each part of a topic the first match counts.
std::span<const KnownMessage> known_messages();
std::span<const CommandWords> known_command_words();
bool is_command_word(std::string_view word);  ///< One of these, numbered or not.
bool is_demand_word(std::string_view word);   ///< Of a demand to a controller: "reference".
/// Whether blanks separate the word, or its letters before a '#', among `words`.
bool is_among_words(std::string_view words, std::string_view word);
/// Why a signal of this name is no input of a model, as far as the name alone tells: "a counter",
/// "a measurement, no command"; "": it may be one.
std::string why_no_input(std::string_view name);
/// The same of a command, of which more is asked: its last word is of an actuator, a side or a
/// number, and no word is of a time stamp, a current, a limit, a demand to a controller.
std::string why_no_command(std::string_view name);
/// What the values of a column tell of the validity of velocities, by its name: velocities are
/// measured where it is 1 (velocity_valid, bottom_lock), where it is 0 (dvl_invalid), or where a
/// figure of merit is small (fom).
enum class Validity { where_1, where_0, merit };
std::optional<Validity> validity_by_name(std::string_view name);
/// The field of a message of this type ("dvl_msgs/DVL") that tells whether its velocities are
/// valid, and the least value of a valid one.
std::optional<std::pair<std::string, double>> validity_of_message(std::string_view type);
/// Words before or behind the name of a column ("true_u", "u_next") that make another of it, and
/// why that is no input.
struct KnownAffix {
  std::string_view words;
  std::string_view why;
};
std::span<const KnownAffix> known_affixes();
/// Fields of a thruster's message, the likeliest first.
std::span<const std::string_view> known_command_fields();
/// Columns of time, besides kTimeNames.
std::span<const std::string_view> known_times();

/// "a.{x,y,z}" as a.x, a.y, a.z; "c{1..3}" and "c[0..2]" alike.
std::vector<std::string> expanded(std::string_view fields);

/// Splits a name into words in lower case, at other characters than letters and digits, and between
/// a small and a capital letter; a unit at the end is dropped, in brackets or as words:
/// "ThrusterLeft/Cmd [V]" gives thruster, left, cmd, and "surge_m_s" gives surge.
std::vector<std::string> words_of(std::string_view name);

/// The unit that the name of a velocity or of a part of a pose ends with: deg/s of "r_dps"; or "".
std::string unit_in_name(std::string_view name);

/// Whether a column is a fin's, rudder's or other control surface's by a word of the name, numbered
/// or not.
bool names_fin(std::string_view column);

/// A part of a pose by the last words of a name: "x" of px, pos_x and north; "z" of depth; "yaw" of
/// psi and heading; roll, pitch, qw, qx, qy, qz. Empty: none.
std::optional<std::string> pose_part_by_name(std::string_view name);

/// The same, but for a demand, an error, a rate, a true value: what a sensor tells of a pose.
std::optional<std::string> measured_pose_part(std::string_view name);

/// The axis of a velocity from the name, 0 to 5 for u, v, w, p, q, r.
std::optional<std::size_t> velocity_by_name(std::string_view name);

}  // namespace kelpie::log
