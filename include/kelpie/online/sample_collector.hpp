// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "kelpie/kernel/mixed_kernel.hpp"
#include "kelpie/kernel/sample_store.hpp"
#include "kelpie/online/density.hpp"
#include "kelpie/online/online_svr.hpp"
#include "kelpie/online/settings.hpp"
#include "kelpie/svr/dual_problem.hpp"

namespace kelpie {

/// How far a learner is on its way to another scale.
enum class RescaleStatus : std::uint8_t {
  refused,    ///< it can't; samples stay in the scale before
  under_way,  ///< there is more to do; samples stay in the scale that they are in
  switched,   ///< there is more to do; from now on samples come in the other scale
  done,       ///< nothing is left to do
};

/// The sample collector: the fixed buffer with all that is kept per sample. One place more than
/// the buffer's size, for the sample that is being learned. Allocates in the constructor only.
class SampleCollector {
 public:
  /// Samples are `inputs` scaled inputs followed by `terms` scaled physics terms.
  SampleCollector(std::size_t inputs, std::size_t terms, const OnlineSvrSettings& settings);

  std::size_t size() const { return samples_.size(); }
  const SampleStore& samples() const { return samples_; }
  const DualProblem& problem() const { return problem_; }
  DualProblem& problem() { return problem_; }  ///< For the solver.
  const MixedKernel& kernel() const { return kernel_; }

  double time(std::size_t i) const { return time_[i]; }               ///< When a sample came [s].
  std::uint64_t arrival(std::size_t i) const { return arrival_[i]; }  ///< 0, 1, 2 … as collected
  /// The number of the sample that arrived so; none if it has left. Cost O(n).
  std::optional<std::size_t> find(std::uint64_t arrival) const;
  /// The number of the first one that arrived so or later; none if there isn't one. Cost O(n).
  std::optional<std::size_t> first_since(std::uint64_t arrival) const;
  std::uint64_t next_arrival() const { return next_arrival_; }    ///< that of the next sample
  double density(std::size_t i) const { return density_.at(i); }  ///< eq. (8)
  /// KernelDensity::novelty() of a sample.
  double novelty(std::span<const double> x) const {
    return density_.novelty(kernel_.inputs_of(x), samples_);
  }
  KnownPlaces known_places() const;  ///< A copy, with room for a full buffer. Allocates.
  /// Brings such a copy up to date. Cost O(n inputs). Allocates nothing.
  void refresh(KnownPlaces& known) const;
  bool idle(std::size_t i) const { return problem_.beta()[i] == 0.0; }  ///< without weight
  std::size_t support_vectors() const;

  /// Compares a sample with the buffer: similarity() and row() are about it until the next call.
  /// Cost O(n d).
  void compare(std::span<const double> x);
  std::span<const double> similarity() const { return {similarity_.data(), size()}; }  ///< κ_SE
  std::span<const double> row() const { return {row_.data(), size()}; }                ///< κ

  /// Adds a sample with β = 0. Requires that compare(x) was the last call, and a free place.
  void collect(std::span<const double> x, double y, double t);

  /// Removes a sample; its weight goes to its nearest neighbours (DualProblem::remove).
  void remove(std::size_t i);

  void clear();  ///< Removes all samples.

  /// Puts every sample through `map(x, y)`, which changes both in place, and computes all that is
  /// kept of them afresh; all weights are 0 then. Cost O(n² d). Allocates nothing.
  void rescale(const SampleMap& map);

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
  std::vector<double> target_;  ///< scratch of rescale()
  std::vector<double> sample_;
  std::uint64_t next_arrival_ = 0;
};

}  // namespace kelpie
