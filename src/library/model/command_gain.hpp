// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "kelpie/motion/term_set.hpp"

namespace kelpie {

/// The vehicle moves as if a command were `factor` times what the command is.
struct CommandGain {
  std::size_t input = 0;  ///< place of the command among the inputs
  double factor = 1.0;    ///< > 0
};

/// The factor of a term where commands have these factors. A command in a term that is no power of
/// this command counts as unchanged.
double term_gain(const TermSet& terms, std::size_t k, std::span<const CommandGain> gains);

}  // namespace kelpie
