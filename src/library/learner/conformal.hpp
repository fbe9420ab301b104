// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// The half width of an interval around a prediction with a promised coverage, learned from the
/// errors one step ahead, for any and also a changing distribution: dynamically tuned adaptive
/// conformal inference (Gibbs & Candès 2022, DtACI).
///
/// The half width is the (1 − ᾱ)-quantile of the last kWindow errors. ᾱ is the weighted mean of the
/// levels of several experts. Each expert follows its misses at a pace γ (Gibbs & Candès 2021,
/// ACI), α ← α + γ (1 − coverage − miss), and is weighted by the quantile loss of its level so far.
/// In any stream an expert's fraction of misses differs from the promised fraction by at most
/// (max(α, 1 − α) + γ) / (γ T) after T samples. The mean of the experts has no such bound, but is
/// closer to the right level under changing errors.
///
/// Units: as the errors. Allocates nothing.
class ConformalInterval {
 public:
  /// Requires 0 < coverage <= 0.99, the limit of kWindow errors.
  explicit ConformalInterval(double coverage);

  /// Half width for the next prediction; infinite before least() errors. A later level beyond the
  /// window gives the largest error of the window.
  double half_width() const { return half_width_; }

  /// Learns from the error |y − f(x)| of a prediction made before y was known; ignores a NaN. Cost
  /// O(kWindow), of moving memory.
  void observe(double error);

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Number of errors before the first interval.
  std::size_t least() const;

 private:
  static constexpr std::size_t kWindow = 250;
  static constexpr std::array kPaces{0.001, 0.002, 0.004, 0.008, 0.016, 0.032, 0.064, 0.128};

  std::span<const double> sorted() const { return std::span(sorted_).first(size_); }
  double level_of(double error) const;
  void update_level(double level);
  void keep(double error);
  double quantile_now() const;

  double miss_;           ///< 1 − coverage, the promised fraction of misses
  double learning_rate_;  ///< η of the experts' weights
  double half_width_;
  std::array<double, kPaces.size()> alpha_{};
  std::array<double, kPaces.size()> weight_{};  ///< with the sum 1
  std::array<double, kWindow> recent_{};        ///< errors in a ring
  std::array<double, kWindow> sorted_{};        ///< recent_ in ascending order
  std::size_t size_ = 0;
  std::size_t next_ = 0;
};

}  // namespace kelpie
