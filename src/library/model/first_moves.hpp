// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/core/scaling.hpp"

namespace kelpie {

/// Tells when a command first moves: by more than ten standard deviations of all its values so far,
/// as when a vehicle sets off after minutes at rest. At rest errors are those of the sensors, and
/// rows tell nothing of the vehicle. Allocates at construction only.
class FirstMoves {
 public:
  explicit FirstMoves(std::vector<std::size_t> commands);  ///< Places of the commands in x.

  /// Takes the next sample; whether a command moves as never before. Cost O(commands²).
  bool update(std::span<const double> x);

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  std::vector<std::size_t> commands_;
  Moments moments_;
  std::vector<double> values_;  // scratch
};

}  // namespace kelpie
