// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kelpie/core/scaling.hpp"
#include "kelpie/model/alignment.hpp"
#include "kelpie/model/settings.hpp"
#include "kelpie/model/steady_part.hpp"
#include "kelpie/motion/term_set.hpp"
#include "kelpie/online/density.hpp"
#include "kelpie/online/regressor.hpp"
#include "kelpie/svr/function_mix.hpp"

namespace kelpie {

/// A model that no longer learns: what is saved, loaded and handed to others. Its predictions are
/// those of the DynamicsModel it was taken from, to the last bit, and so is what it does with spans
/// of another size (InputError) and numbers that aren't finite (a prediction of NaN).
struct TrainedModel {
  /// The model of one target.
  struct Axis {
    std::string name;  ///< target column
    AxisScaling scaling;
    FunctionMix function;  ///< of one member where a learner was alone
    double kkt_gap = 0.0;  ///< with which the learner was in service
    SteadyModel steady{};  ///< for rollouts; not ready() where the velocities aren't known
    /// Of the interval around predictions, as it was at the end; infinite where nothing is
    /// promised.
    double half_width = std::numeric_limits<double>::infinity();
    std::optional<KnownPlaces> known{};  ///< none in files of older versions
  };

  std::vector<std::string> input_names;
  ModelSettings settings;
  TermSet terms;  ///< the physics terms of every axis
  std::vector<Axis> axes;
  /// How commands were shifted before the model saw them. Predictions are of inputs that are
  /// shifted already: whoever has rows of a log gives them to AlignedRows first.
  Alignment alignment{};

  std::vector<std::string> target_names() const;  ///< Of all axes, in order. Allocates.

  /// One prediction of every axis in raw units: x is of input_names.size() values, y of
  /// axes.size(). Allocates nothing; safe from many threads.
  void predict(std::span<const double> x, std::span<double> y) const;

  /// The same with interval and novelty, as they were of the DynamicsModel at its end. The interval
  /// was learned from errors one step ahead; nobody follows it any more. No disturbance. Cost:
  /// three kernel rows per axis. Allocates nothing; safe from many threads.
  void predict(std::span<const double> x, std::span<Prediction> y) const;

  /// The same, to rounding, with the Jacobian in raw units, row-major: ∂y_i/∂x_j at
  /// jacobian[i · inputs + j], of axes.size() · inputs values. At a kink of a physics term the
  /// slope is that to the right; where a term isn't finite, or its slope isn't, it counts 0. Cost
  /// once to twice that of predict(). Allocates nothing; safe from many threads.
  void predict_with_jacobian(std::span<const double> x, std::span<double> y,
                             std::span<double> jacobian) const;
};

}  // namespace kelpie
