// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kelpie/model/scaled.hpp"
#include "kelpie/model/settings.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/online/adaptive_svr.hpp"

namespace kelpie {

/// The vehicle's dynamics, learned while it drives: accelerations (or any targets) from velocities,
/// commands, or any inputs, one learner per axis (eq. 3).
///
///     DynamicsModel model({"u", "v", "r", "th1", "th2", "th3"}, {"udot", "vdot", "rdot"},
///                         ModelSettings::from_preset("default", 3));
///     model.update(x, y, t);      // at every sample
///     model.predict(x, y);        // whenever a prediction is wanted
class DynamicsModel {
 public:
  /// The scaling is taken from the first samples. Throws InputError on settings that don't
  /// validate, no inputs or more than kMostInputs, no targets, or settings for another number.
  DynamicsModel(std::vector<std::string> inputs, std::vector<std::string> targets,
                const ModelSettings& settings);

  /// The scaling is given, one per target.
  DynamicsModel(std::vector<std::string> inputs, std::vector<std::string> targets,
                const ModelSettings& settings, std::span<const AxisScaling> scaling);

  std::size_t inputs() const { return input_names_.size(); }
  std::size_t axes() const { return axes_.size(); }

  /// Every axis learns from one sample; what happened to it stands in axis(i).
  /// Requires x of inputs() and y of axes() values, in the units of the log; t [s] never
  /// decreasing.
  void update(std::span<const double> x, std::span<const double> y, double t);

  /// Requires x of inputs() and y of axes() values.
  void predict(std::span<const double> x, std::span<double> y) const;

  /// One axis on its own: axes don't know each other, so each may be run where it pleases.
  OnlineRegressor& axis(std::size_t i) { return axes_[i]; }
  const Scaled<AdaptiveSvr>& axis(std::size_t i) const { return axes_[i]; }

  /// Whether every axis has a model in service.
  bool ready() const;

  /// A copy of the models in service. Requires ready().
  TrainedModel trained() const;

  /// Memory of all learners in bytes, known before there is a model. Requires settings that
  /// validate.
  static std::size_t bytes(std::span<const std::string> inputs, const ModelSettings& settings);

 private:
  DynamicsModel(std::vector<std::string> inputs, std::vector<std::string> targets,
                ModelSettings settings, const AxisScaling* scaling);

  std::vector<std::string> input_names_;
  std::vector<std::string> target_names_;
  ModelSettings settings_;
  std::vector<Scaled<AdaptiveSvr>> axes_;
};

}  // namespace kelpie
