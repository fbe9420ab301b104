// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/kernel/sample_store.hpp"
#include "kelpie/kernel/squared_exponential.hpp"

namespace kelpie {

/// Kernel density of a buffer's samples at each of them (eq. 8), H = h Σ^½ on raw inputs, which is
/// h times the identity on scaled ones; κ is the standard Gaussian without its constant. Kept up
/// to date with one kernel row per arrival or departure. Allocates in the constructor only.
class KernelDensity {
 public:
  /// Sums of kernel values below this are rounding: there is nobody within some six bandwidths.
  static constexpr double kEmptyDensity = 1e-9;

  /// `bandwidth` h > 0, in standard deviations of the inputs.
  KernelDensity(std::size_t dimension, std::size_t capacity, double bandwidth);

  /// Scott's rule: h = n^(−1/(d+4)).
  static double scott(std::size_t dimension, std::size_t samples);

  /// Call before the sample z joins `samples`, of which the first `dimension` coordinates count.
  /// Cost O(n d).
  void add(std::span<const double> z, const SampleStore& samples);

  /// Call while sample i is still in `samples`; numbering then follows SampleStore. Cost O(n d).
  void remove(std::size_t i, const SampleStore& samples);

  void clear() { size_ = 0; }  ///< Removes all samples.

  double bandwidth() const { return bandwidth_; }
  /// Σ_j κ of each sample with all samples; enough to go on with (assume()).
  std::span<const double> sums() const { return {sum_.data(), size_}; }
  void assume(std::span<const double> sums);  ///< Requires no more than the capacity.

  /// d(x_i), per unit volume of the scaled inputs.
  double at(std::size_t i) const { return sum_[i] / (determinant_ * static_cast<double>(size_)); }

  /// How new the place z is to the buffer: the share of its samples that lie in a denser place. z
  /// counts as one more sample, and every density is that of all other samples (leave-one-out). 0:
  /// no sample lies denser; 1: all do, or none is near at all; 1 too for an empty buffer. Where z
  /// has the distribution of the samples, every rank is equally likely. Requires `samples` as they
  /// were added, and z of as many coordinates as count. Cost: two kernel rows. Allocates nothing;
  /// safe from many threads.
  double novelty(std::span<const double> z, const SampleStore& samples) const;

  /// core/archive.hpp; of so many samples.
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
  std::vector<double> sum_;  ///< Σ_j κ(H⁻¹(x_i − x_j)), over all j including i
  std::vector<double> row_;
  std::vector<double> leaving_;
};

/// Where a learner has samples, to tell without the learner how new another place is.
struct KnownPlaces {
  SampleStore samples;  ///< scaled inputs
  KernelDensity density;

  /// KernelDensity::novelty().
  double novelty(std::span<const double> z) const { return density.novelty(z, samples); }
};

}  // namespace kelpie
