// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kelpie/svr/settings.hpp"
#include "svr/density.hpp"
#include "svr/dual_problem.hpp"
#include "svr/mixed_kernel.hpp"
#include "svr/sample_store.hpp"

namespace kelpie {

/// The sample collector: the buffer with the data of its samples. Has a place more than the
/// buffer's size, for the sample in learning. Allocates in the constructor only.
class SampleCollector {
 public:
  /// A sample consists of `inputs` scaled inputs and `terms` scaled physics terms.
  SampleCollector(std::size_t inputs, std::size_t terms, const OnlineSvrSettings& settings);

  std::size_t size() const { return samples_.size(); }
  const SampleStore& samples() const { return samples_; }
  const DualProblem& problem() const { return problem_; }
  DualProblem& problem() { return problem_; }  ///< For the solver.
  const MixedKernel& kernel() const { return kernel_; }

  double time(std::size_t i) const { return time_[i]; }  ///< Time of a sample [s].
  /// Arrivals of the samples, counted from 0.
  std::span<const std::uint64_t> arrivals() const { return {arrival_.data(), size()}; }
  const KernelDensity& density() const { return density_; }  ///< eq. (8)

  /// Compares a sample with the buffer, for similarity() and row(). Cost O(n d).
  void compare(std::span<const double> x);
  std::span<const double> similarity() const { return {similarity_.data(), size()}; }  ///< κ_SE
  std::span<const double> row() const { return {row_.data(), size()}; }                ///< κ

  /// Adds a sample with β = 0. Requires that compare(x) was the last call, and a free place.
  void collect(std::span<const double> x, double y, double t);

  /// Removes a sample; its weight goes to its nearest neighbours (DualProblem::remove).
  void remove(std::size_t i);

  void clear();  ///< Removes every sample.

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Memory of a buffer in bytes, beside the object itself.
  static std::size_t bytes(std::size_t inputs, std::size_t terms,
                           const OnlineSvrSettings& settings);

 private:
  MixedKernel kernel_;
  SampleStore samples_;
  DualProblem problem_;
  double ridge_;
  KernelDensity density_;
  std::vector<double> time_;
  std::vector<std::uint64_t> arrival_;
  std::vector<double> similarity_;
  std::vector<double> row_;
  std::uint64_t next_arrival_ = 0;
};

/// Whether a sample has no weight.
inline bool weightless(const SampleCollector& buffer, std::size_t i) {
  return buffer.problem().beta()[i] == 0.0;
}

/// KernelDensity::novelty() of a sample.
double novelty(const SampleCollector& buffer, std::span<const double> x);

/// A copy of the samples' places, with room for a full buffer. Allocates.
KnownPlaces known_places(const SampleCollector& buffer);

/// Updates such a copy. Cost O(n inputs). Allocates nothing.
void refresh(KnownPlaces& known, const SampleCollector& buffer);

}  // namespace kelpie
