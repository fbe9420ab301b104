// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "kelpie/alignment/alignment.hpp"
#include "log/dataset.hpp"

namespace kelpie::study {

/// A quick test whether the velocities and commands of a log belong together: recursive least
/// squares (make_least_squares) on the training rows, scored on the held-out rows.
struct FirstLook {
  struct Axis {
    std::string target;
    double r2 = std::numeric_limits<double>::quiet_NaN();
    double r2_without_commands = r2;  ///< with the velocities as the only inputs
  };
  std::size_t rows = 0;
  std::size_t held_out = 0;
  double rate_hz = 0.0;
  AlignmentResult alignment;  ///< of the commands, found on the training rows
  std::vector<Axis> axes;
};

/// Holds out every fifth of 25 pieces of rows. Throws InputError where the log is too short for a
/// split. Cost: choose_alignment(), and O(m²) per row for m terms.
FirstLook first_look(const log::Dataset& data);

}  // namespace kelpie::study
