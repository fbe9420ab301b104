// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace kelpie {

/// What can have become of a vehicle, each with one size.
enum class CauseKind : std::uint8_t {
  thruster,      ///< gives another share of its thrust; size: that share, 1 as before
  drag,          ///< of an axis; size: factor on its damping
  load,          ///< carried or dropped; size: factor on the inertia along the first axis
  force,         ///< constant in the body; size: acceleration of an axis, in the target's unit
  sensor_scale,  ///< a velocity reads so many times the truth; size: that factor
  sensor_bias,   ///< a velocity reads so much too much; size: in its unit
  frozen,        ///< a velocity stands still; size: where
};

inline constexpr std::size_t kCauseKinds = 7;  ///< of CauseKind

/// One cause with its size and the interval that holds the true size with a probability of 0.9.
struct Cause {
  CauseKind kind = CauseKind::thruster;  ///< what its size is
  std::size_t place = 0;  ///< input of a thruster or sensor; target of drag, force; load: 0
  double size = 0.0;      ///< best estimate
  double lower = 0.0;     ///< end of the interval
  double upper = 0.0;     ///< the other end
};

/// How far a change has been explained.
enum class FindingState : std::uint8_t {
  looking,    ///< something has changed; the rows so far don't tell what
  named,      ///< one cause explains it, or two together do (`count`)
  ambiguous,  ///< one cause explains it, and `rival` hardly worse: drive what tells them apart
  none,       ///< no cause here nor any two explain it
};

inline constexpr std::size_t kFindingStates = 4;  ///< of FindingState

/// A change of the vehicle and what explains it.
struct Finding {
  double since_s = 0.0;                        ///< when it happened, to one block of rows
  double found_s = 0.0;                        ///< when it was found
  double told_s = 0.0;                         ///< when `state` came to be what it is
  FindingState state = FindingState::looking;  ///< how far it has been explained
  bool settled = false;         ///< no more rows are looked at; the vehicle is now taken as it is
  std::size_t count = 0;        ///< of causes: 1 or 2; 0 where there is no name
  std::array<Cause, 2> causes;  ///< the first `count` of them
  Cause rival;                  ///< of the next best explanation
  double evidence = 0.0;        ///< log likelihood ratio of the explanation against no change
  double margin = 0.0;          ///< … and against that of `rival`
  double explained = 0.0;       ///< share of what a refit without any restriction explains, 0 to 1
};

}  // namespace kelpie
