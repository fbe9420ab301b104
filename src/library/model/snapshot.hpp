// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>

#include "kelpie/core/scaling.hpp"
#include "kelpie/motion/term_set.hpp"
#include "kelpie/svr/regressor.hpp"
#include "learner/disturbance.hpp"
#include "model/steady_part.hpp"
#include "svr/density.hpp"
#include "svr/function_mix.hpp"
#include "svr/squared_exponential.hpp"

namespace kelpie {

static_assert(kMostInputs <= SquaredExponential::kMostDimensions);

/// The uncertainty around the predictions of one axis, in the target's unit.
struct IntervalState {
  double half_width = std::numeric_limits<double>::infinity();            ///< of the interval
  double corrected_half_width = std::numeric_limits<double>::infinity();  ///< with the disturbance
  const Disturbance* disturbance = nullptr;                               ///< null: not estimated

  /// `value` with its intervals, for a sample `ahead_s` [s] after the last learned sample. The
  /// interval with the disturbance is finite for the next sample only.
  Prediction prediction(double value, double novelty, double ahead_s) const;
};

/// The gradient of an axis by its raw inputs, y = mean + scale f(z, φ), from the gradient by the
/// scaled sample:
///
///     ∂y/∂x = scale (Wᵀ ∂f/∂z + Σ_k ∂f/∂φ_k / scale_k ∂φ_k/∂x),
///
/// with the values of TermSet::add_gradient at kinks of terms. Overwrites `by_sample`. Requires
/// finite x and room for x.size() values. Allocates nothing; safe from many threads.
void pull_back(const AxisScaling& scaling, const TermSet& terms, std::span<const double> x,
               std::span<double> by_sample, std::span<double> gradient);

/// The evaluator of every model in service, live, shared or trained: raw inputs to predictions in
/// the unit of the target. `Function` takes scaled samples: operator() and with_gradient(), as
/// FunctionMix. Refers to the parts of a model. Allocates nothing; safe from many threads.
template <typename Function>
struct ServedAxis {
  const AxisScaling& scaling;
  const TermSet& terms;
  const Function& function;

  double predict(std::span<const double> x) const {
    return scaling.target.invert(function(as_span(scale_sample(scaling, terms, x))));
  }

  /// The prediction with intervals and `novelty(scaled inputs)`.
  template <typename Novelty>
  Prediction assess(std::span<const double> x, const IntervalState& intervals, Novelty novelty,
                    double ahead_s) const {
    const ScaledSample z = scale_sample(scaling, terms, x);
    const double value = scaling.target.invert(function(as_span(z)));
    return intervals.prediction(value, novelty(as_span(z).first(x.size())), ahead_s);
  }

  /// The prediction, equal to predict() to rounding, and its gradient by the raw inputs. Conditions
  /// as pull_back(). Cost once to twice that of predict().
  double predict_with_gradient(std::span<const double> x, std::span<double> gradient) const {
    const ScaledSample sample = scale_sample(scaling, terms, x);
    ScaledSample slopes(sample.size());
    const double value = function.with_gradient(as_span(sample), slopes);
    pull_back(scaling, terms, x, slopes, gradient);
    return scaling.target.invert(value);
  }
};

/// The model of one axis as it was in service at one moment: an axis of a TrainedModel, and the
/// state that a SharedModel publishes (DynamicsAxis::refresh). Predictions are those of the model
/// to the last bit. Functions take the physics terms of the model. Allocates nothing; safe from
/// many threads.
struct Snapshot {
  std::string name;  ///< target column
  AxisScaling scaling;
  FunctionMix function;  ///< of one member where the learner is alone
  double kkt_gap = 0.0;  ///< of the learner in service
  SteadyModel steady{};  ///< for rollouts; not ready() where the velocities aren't known
  /// Half width of the interval around predictions; infinite without a promise.
  double half_width = std::numeric_limits<double>::infinity();
  std::optional<KnownPlaces> known{};  ///< empty in files of older versions
  /// Of a live model only: the disturbance, and the half width of the interval that includes it.
  double corrected_half_width = std::numeric_limits<double>::infinity();
  std::optional<Disturbance> disturbance{};

  double predict(const TermSet& terms, std::span<const double> x) const;

  /// The prediction with intervals, novelty (NaN without known places) and disturbance. Cost: three
  /// kernel rows.
  Prediction assess(const TermSet& terms, std::span<const double> x, double ahead_s = 0.0) const;

  /// ServedAxis::predict_with_gradient().
  double predict_with_gradient(const TermSet& terms, std::span<const double> x,
                               std::span<double> gradient) const;
};

}  // namespace kelpie
