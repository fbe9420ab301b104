// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kelpie/kernel/sample_store.hpp"
#include "kelpie/kernel/squared_exponential.hpp"
#include "kelpie/online/density.hpp"
#include "kelpie/online/settings.hpp"
#include "kelpie/svr/dual_problem.hpp"

namespace kelpie {

/// The sample collector: the fixed buffer with all that is kept per sample. One place more than
/// the buffer's size, for the sample that is being learned. Allocates in the constructor only.
class SampleCollector {
 public:
  SampleCollector(std::size_t inputs, const OnlineSvrSettings& settings);

  std::size_t size() const { return samples_.size(); }
  const SampleStore& samples() const { return samples_; }
  const DualProblem& problem() const { return problem_; }
  DualProblem& problem() { return problem_; }
  const SquaredExponential& kernel() const { return kernel_; }

  double time(std::size_t i) const { return time_[i]; }
  std::uint64_t arrival(std::size_t i) const { return arrival_[i]; }  ///< 0, 1, 2 … as collected
  double density(std::size_t i) const { return density_.at(i); }      ///< eq. (8)
  bool idle(std::size_t i) const { return problem_.beta()[i] == 0.0; }  ///< without weight
  std::size_t support_vectors() const;

  /// κ(z, x_i) against the buffer, valid until the next call. Cost O(n d).
  std::span<const double> similarity(std::span<const double> z);

  /// Adds a sample with β = 0. Requires that similarity(z) was the last call, and a free place.
  void collect(std::span<const double> z, double y, double t);

  /// Removes a sample; its weight goes to its nearest neighbours (DualProblem::remove).
  void remove(std::size_t i);

  /// Memory of a buffer in bytes, beside the object itself.
  static std::size_t bytes(std::size_t inputs, const OnlineSvrSettings& settings);

 private:
  SquaredExponential kernel_;
  SampleStore samples_;
  DualProblem problem_;
  double self_;  ///< κ(x, x) with the ridge
  KernelDensity density_;
  std::vector<double> time_;
  std::vector<std::uint64_t> arrival_;
  std::vector<double> row_;
  std::uint64_t next_arrival_ = 0;
};

}  // namespace kelpie
