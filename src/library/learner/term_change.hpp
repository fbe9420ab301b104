// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/core/archive.hpp"
#include "kelpie/svr/online_svr.hpp"

namespace kelpie {

/// How a vehicle has changed since the samples of a learner, as a linear function of the physics
/// terms φ of a scaled sample (z, φ): wᵀφ + b, in units of the standardised target. No change at
/// first. Allocates in the constructor only.
class TermChange {
 public:
  TermChange(std::size_t inputs, std::size_t terms) : inputs_(inputs), weights_(terms + 1) {}

  bool any() const { return any_; }  ///< Whether there is a change.

  /// wᵀφ + b; 0 without a change, or for a sample of another length.
  double operator()(std::span<const double> z) const;

  std::span<const double> weights() const { return weights_; }  ///< w, then b.

  void add(std::span<const double> step);  ///< w, then b, grow by `step`.
  void clear();                            ///< No change.

  /// Moves to another scale. `z`: scratch of a sample's length. Cost: two maps.
  void rescale(const SampleMap& map, std::span<double> z);

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  std::size_t inputs_;
  std::vector<double> weights_;
  bool any_ = false;
};

}  // namespace kelpie
