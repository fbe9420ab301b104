// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "svr/sample_store.hpp"
#include "svr/squared_exponential.hpp"

namespace kelpie {

/// Kernel density of a buffer's samples at the samples (eq. 8). H = h Σ^½ on raw inputs is h times
/// the identity on scaled inputs; κ is the standard Gaussian without its constant. Arrival and
/// departure of a sample cost a kernel row each. Allocates in the constructor only.
class KernelDensity {
 public:
  /// Sums of kernel values below this limit are rounding: no sample within six bandwidths.
  static constexpr double kEmptyDensity = 1e-9;
  static constexpr double kRounding = 1e-6;  ///< by which places are as dense, at least

  /// `bandwidth` h > 0, in standard deviations of the inputs.
  KernelDensity(std::size_t dimension, std::size_t capacity, double bandwidth);

  /// Scott's rule: h = n^(−1/(d+4)).
  static double scott(std::size_t dimension, std::size_t samples);

  /// Adds a sample z; to be called before z joins `samples`. Uses the first `dimension`
  /// coordinates. Cost O(n d).
  void add(std::span<const double> z, const SampleStore& samples);

  /// Removes sample i; to be called while i is still in `samples`. Numbering as SampleStore. Cost
  /// O(n d).
  void remove(std::size_t i, const SampleStore& samples);

  void clear() { size_ = 0; }  ///< Removes all samples.

  double bandwidth() const { return bandwidth_; }
  /// Σ_j κ of each sample with every sample; the whole state, see assume().
  std::span<const double> sums() const { return {sum_.data(), size_}; }
  void assume(std::span<const double> sums);  ///< Restores sums(). Requires room.

  /// d(x_i), per unit volume of the scaled inputs.
  double at(std::size_t i) const { return sum_[i] / (determinant_ * static_cast<double>(size_)); }

  /// Novelty of the place z for the buffer: the fraction of samples in a denser place. z counts as
  /// a further sample, and densities exclude the sample itself (leave-one-out). 0: no sample in a
  /// denser place; 1: every sample in a denser place, or no sample near z, or an empty buffer. For
  /// z with the distribution of the samples every rank is equally likely. Requires `samples` as
  /// added, and z of `dimension` coordinates. Cost: two kernel rows. Allocates nothing; safe from
  /// many threads.
  double novelty(std::span<const double> z, const SampleStore& samples) const;

  /// core/archive.hpp, for a number of samples.
  void visit(Archive& archive, std::size_t samples);

  /// Memory in bytes, beside the object itself.
  static std::size_t bytes(std::size_t dimension, std::size_t capacity) {
    return (dimension + 2 * capacity) * sizeof(double);
  }

 private:
  double bandwidth_;
  SquaredExponential kernel_;
  double determinant_;  ///< of h times the identity
  std::size_t size_ = 0;
  std::vector<double> sum_;  ///< Σ_j κ(H⁻¹(x_i − x_j)), j = i included
  std::vector<double> row_;
  std::vector<double> leaving_;
};

/// The places of a learner's samples, for novelty without the learner.
struct KnownPlaces {
  SampleStore samples;  ///< scaled inputs
  KernelDensity density;

  /// KernelDensity::novelty().
  double novelty(std::span<const double> z) const { return density.novelty(z, samples); }
};

}  // namespace kelpie
