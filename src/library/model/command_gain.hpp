// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace kelpie {

/// The vehicle moves as if a command were `factor` times what the command is.
struct CommandGain {
  std::size_t input = 0;  ///< place of the command among the inputs
  double factor = 1.0;    ///< > 0
};

}  // namespace kelpie
