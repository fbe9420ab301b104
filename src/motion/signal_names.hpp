// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace kelpie {

// The only table of signal names: velocities for velocity_axis() and for drafts of [log], commands
// for drafts and for `kelpie identify`.

/// The axis (0 to 5: u, v, w, p, q, r) of a velocity name with one meaning, in lower case.
std::optional<std::size_t> certain_velocity_axis(std::string_view name);

/// The axis of a name that is likely a velocity, for drafts: lower-case words joined by "_".
std::optional<std::size_t> likely_velocity_axis(std::string_view name);

/// A name of a command: a column of a CSV file, a message with one number, a field of an unknown
/// message type.
struct CommandName {
  enum class Kind : std::uint8_t { thrust, angle, wrench };
  /// Use for names of thruster speeds in identification.
  enum class Thruster : std::uint8_t {
    no,
    prefix,    ///< for every name that begins with the word
    numbered,  ///< for the word with a number
  };

  std::string_view word;  ///< lower case; "rpm#": also rpm1, rpm2; "u_speed": the whole name
  Kind kind;              ///< two words of a kind for the same thrusters are alternatives
  int rank;               ///< in drafts, the least first; 0: not in drafts
  Thruster thruster = Thruster::no;
  std::string_view why = {};  ///< remark in the draft
};

std::span<const CommandName> command_names();  ///< The names for drafts.

/// Whether identification takes the column for a thruster's speed.
bool names_thruster(std::string_view column);

}  // namespace kelpie
