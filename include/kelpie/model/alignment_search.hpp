// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kelpie/model/alignment.hpp"

namespace kelpie {

/// The rows of a log from which the alignment is to be told.
struct AlignmentProblem {
  std::span<const double> inputs;       ///< row-major, all rows of the log; finite
  std::span<const double> targets;      ///< row-major, all rows of the log; finite
  std::span<const double> times_s;      ///< never decreasing
  std::span<const int> configurations;  ///< of the vehicle, per row; empty: it never changes
  std::span<const std::size_t> rows;    ///< one or more, going up; others aren't looked at
  std::vector<std::string> input_names;
  std::size_t target_count = 1;
  std::string states = "auto";  ///< find_states
  double rate_hz = 1.0;         ///< usual rows per second
  int current_rows = 0;         ///< the shift that another has to be clearly better than
};

/// What was found, and why.
struct AlignmentFound {
  Alignment alignment;  ///< its commands are told even where it is none
  double gain = 0.0;    ///< share of what was unexplained with the shift in use that it explains
  std::string why;      ///< in words
};

/// Which inputs are commands: all but velocities. Velocities are those of `states`; else those that
/// have their names (named_velocities()); else for each target the input whose slope over half a
/// second goes with it best (correlation above 0.5), a different one each. Places of inputs, going
/// up; none where no velocity is known.
std::vector<std::size_t> find_commands(const AlignmentProblem& problem);

/// The same by names alone, where there are no rows yet; none where they don't tell.
std::vector<std::size_t> named_commands(std::span<const std::string> inputs, std::size_t targets,
                                        const std::string& states);

/// Looks for one shift of all commands, from -1 to 1 s in about 20 steps of whole rows. For each
/// the targets are fitted by least squares on x, x|x|, products of velocities and 1, in 5
/// contiguous folds of the rows: fitted to four, judged on the fifth. The shift with the least
/// error is taken on clear evidence only: a mean gain of 3 % or more (in logarithms) over folds and
/// targets, and a gain in 60 % of them, and no loss to a kernel ridge regression on 300 rows of
/// each fifth, which follows vehicles that the terms describe badly. Else the one in use stays
/// (none, as long as there is none), with the reason. Values far out are clipped, so that a few
/// absurd ones can't decide. One shift for all targets: it keeps one row one sample, and a shift of
/// its own for each explained hardly more on all vehicles at hand. Throws InputError on a
/// specification of states that names no inputs. Cost: 21 fits to at most 20,000 rows.
AlignmentFound find_alignment(const AlignmentProblem& problem);

}  // namespace kelpie
