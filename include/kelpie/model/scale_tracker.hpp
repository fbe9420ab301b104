// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kelpie/core/scaling.hpp"
#include "kelpie/model/settings.hpp"
#include "kelpie/online/sample_collector.hpp"
#include "kelpie/physics/term_set.hpp"

namespace kelpie {

/// The scale of one axis: given, or measured on the samples so far, which all weigh alike. A scale
/// that was measured is taken anew when the samples have left it by the ratio `track`; a few times
/// in a life. It tells when it is time (next()); its owner goes over (adopt()).
class ScaleTracker {
 public:
  /// Requires inputs <= kMostInputs, and a scaling that was made for these inputs and terms.
  ScaleTracker(std::size_t inputs, const SharedSettings& settings, TermSet terms,
               std::optional<AxisScaling> given);

  std::size_t inputs() const { return inputs_; }
  const TermSet& terms() const { return terms_; }

  /// The scale in use; null before the first adopt(), unless one was given.
  const AxisScaling* scaling() const { return scaling_ ? &*scaling_ : nullptr; }

  /// Counts one more sample, where it can still have a say. Cost O(d² + m²) for m terms. Allocates
  /// nothing.
  void observe(std::span<const double> x, double y);

  /// Mean of the targets counted; 0 before the first.
  double mean_target() const;

  /// The scale to go over to now, if any. The first one: as soon as the samples determine it (the
  /// covariance of the inputs can be inverted, the target moves). Later ones: looked for at every
  /// 64th sample. Allocates at these looks.
  std::optional<AxisScaling> next() const;
  void adopt(AxisScaling next);  ///< `next` is the scale in use from now on.

  /// Puts a sample of the scale in use into another one. Requires scaling(), and that this and
  /// `next` stay where they are.
  SampleMap map_to(const AxisScaling& next) const;

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  std::optional<AxisScaling> measured() const;
  bool outgrown(const AxisScaling& scaling) const;

  std::size_t inputs_;
  ScalingKind kind_;
  double track_;  ///< 0: the scale stays
  bool given_;
  TermSet terms_;
  Moments input_moments_;  ///< none of the three are counted where the scale was given
  Moments target_moments_;
  Moments term_moments_;
  std::vector<double> term_values_;  ///< scratch
  std::optional<AxisScaling> scaling_;
};

}  // namespace kelpie
