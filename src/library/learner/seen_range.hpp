// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "kelpie/core/archive.hpp"
#include "svr/function_mix.hpp"

namespace kelpie {

/// The range of the seen targets, the limits of predictions: from the third smallest to the third
/// largest target, against outliers, with a margin of a tenth of its width on either side. Before
/// kLeast targets: from the smallest to the largest, with a margin of a standard deviation.
/// Allocates nothing.
class SeenRange {
 public:
  void add(double y);  ///< Requires no NaN.

  Limits limits() const;  ///< Infinite before the first target.

  /// Restores limits; infinite limits: as clear().
  void resume_from(const Limits& limits);

  /// Targets y become gain · y + offset. Requires gain > 0.
  void rescale(double gain, double offset);

  void clear() { *this = {}; }  ///< Forgets the targets.

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  static constexpr std::size_t kEnds = 3;
  static constexpr std::size_t kLeast = 20;

  std::array<double, kEnds> least_{};     ///< ascending
  std::array<double, kEnds> greatest_{};  ///< descending
  std::size_t count_ = 0;
};

}  // namespace kelpie
