// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kelpie/core/scaling.hpp"
#include "kelpie/model/settings.hpp"
#include "kelpie/motion/term_set.hpp"
#include "kelpie/svr/regressor.hpp"
#include "model/warm_up.hpp"

namespace kelpie {

/// The scale between an axis in the units of the log and a learner of scaled samples: scaled
/// inputs, scaled physics terms (TermSet), standardised target. Without a given scaling, the first
/// samples are held back until `warmup` samples determine a scale, without absurd samples. While
/// all inputs are constant, the axis waits; then the last `warmup` samples give the scale. A
/// constant input is left out. Once the scale is known, the held samples are learned in order, a
/// few per update; new samples are queued behind them. The scale stays. Decisions and predictions
/// are in raw units, except the KKT gap. The learner is an argument of every call, the same in
/// each.
class FirstScale {
 public:
  /// Requires inputs <= kMostInputs, and a given scaling of these inputs and terms.
  FirstScale(std::size_t inputs, const SharedSettings& settings, TermSet terms,
             std::optional<AxisScaling> given);

  /// Allocates while samples are held back and when the scale is found; later nothing.
  Decision update(OnlineRegressor& learner, std::span<const double> x, double y, double t);

  /// Learns all held samples, once the scale is known.
  void learn_held_back(OnlineRegressor& learner);

  /// Before the scale is known: the mean of the targets so far (0 at the start).
  double predict(const OnlineRegressor& learner, std::span<const double> x) const;

  Status status(const OnlineRegressor& learner) const;

  const TermSet& terms() const { return terms_; }

  /// Null while samples are held back for a scale.
  const AxisScaling* scaling() const { return scaling_ ? &*scaling_ : nullptr; }

  /// Continues with the scale of a trained model. Requires no given scale and no samples yet.
  void resume_from(const AxisScaling& scaling) { scaling_ = scaling; }

  void visit(Archive& archive);  ///< core/archive.hpp; without the learner

 private:
  Decision hold_back(OnlineRegressor& learner, std::span<const double> x, double y, double t);
  Decision stand_in_line(OnlineRegressor& learner, std::span<const double> x, double y, double t);
  Decision learn(OnlineRegressor& learner, std::span<const double> x, double y, double t);
  void learn_held(OnlineRegressor& learner, Decision& decision);
  void observe(std::span<const double> x, double y);
  bool find();
  double mean_target() const;

  std::size_t inputs_;
  ScalingKind kind_;
  bool given_;
  TermSet terms_;
  Moments input_moments_;
  Moments target_moments_;
  Moments term_moments_;
  std::vector<double> term_values_;  ///< scratch
  std::optional<AxisScaling> scaling_;
  WarmUp warm_up_;
  std::int64_t invalid_ = 0;
  std::int64_t implausible_ = 0;  ///< among the first samples
  std::int64_t held_ = 0;         ///< samples since `warmup` samples were held
};

/// Which held-back samples are plausible: no value lies ten times as far from the median as the 5th
/// or 95th percentile; no input's value has three times the 95th percentile of magnitudes besides.
/// Allocates.
std::vector<bool> plausible_samples(const WarmUp& samples, std::size_t inputs);

}  // namespace kelpie
