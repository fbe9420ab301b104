// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/core/scaling.hpp"
#include "kelpie/svr/decision.hpp"

namespace kelpie {

/// Tells when a vehicle sets off after minutes at rest: a command moves by more than ten standard
/// deviations of all its values so far, and the model explains less than half of the variance of
/// every target so far. At rest errors are those of the sensors, and rows tell nothing of the
/// vehicle. Allocates at construction only.
class FirstMoves {
 public:
  /// Places of the commands in x, and the number of axes.
  FirstMoves(std::vector<std::size_t> commands, std::size_t axes);

  /// Takes the next sample with the decisions about it; whether the vehicle sets off. Cost
  /// O(commands²).
  bool update(std::span<const double> x, std::span<const double> y,
              std::span<const Decision> decisions);

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  struct Explained {
    double samples = 0.0, mean = 0.0;
    double spread = 0.0;       // sum of squared deviations from the mean so far
    double unexplained = 0.0;  // sum of squared errors
  };

  bool explains() const;

  std::vector<std::size_t> commands_;
  Moments moments_;
  std::vector<double> values_;  // scratch
  std::vector<Explained> axes_;
};

}  // namespace kelpie
