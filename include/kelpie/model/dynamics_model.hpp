// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/model/dynamics_axis.hpp"
#include "kelpie/model/settings.hpp"
#include "kelpie/model/trained_model.hpp"

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

  /// Every axis learns from one sample, and tells the others when it finds a change; what happened
  /// stands in decisions() and axis(i).
  /// Requires x of inputs() and y of axes() values, in the units of the log; t [s] never
  /// decreasing.
  void update(std::span<const double> x, std::span<const double> y, double t);

  /// What the last update() made of its sample, one per axis.
  std::span<const Decision> decisions() const { return decisions_; }

  /// Requires x of inputs() and y of axes() values.
  void predict(std::span<const double> x, std::span<double> y) const;

  /// The same with the Jacobian, as TrainedModel::predict_with_jacobian. An axis without a model in
  /// service gives the mean of its targets so far, and zeros.
  void predict_with_jacobian(std::span<const double> x, std::span<double> y,
                             std::span<double> jacobian) const;

  /// The same with intervals and novelty, in the units of the log: where the next samples lie with
  /// the share `coverage` of the settings, if they are learned one after the other, and how new
  /// their place is to the buffer (docs/uncertainty.md). Cost: three kernel rows per axis.
  /// Allocates nothing. Requires y of axes() values.
  void predict(std::span<const double> x, std::span<Prediction> y) const;

  /// One axis on its own, to be run where it pleases; then nobody tells it what the others find
  /// (tell_others()).
  OnlineRegressor& axis(std::size_t i) { return axes_[i]; }
  /// The learner of an axis, to look at.
  const Scaled<AdaptiveSvr>& axis(std::size_t i) const { return axes_[i].learner(); }

  /// The past models of an axis (docs/memory.md). Allocates.
  std::vector<RememberedModel> remembered(std::size_t axis) const {
    return axes_[axis].learner().remembered();
  }

  /// Gives an axis past models of an earlier run, to be taken up when their vehicle returns.
  /// Requires that nothing has been learned yet, inputs of the same number, order and units, no
  /// more models than the setting `memory`, samples in each, and finite numbers.
  void remember(std::size_t axis, std::vector<RememberedModel> models) {
    axes_[axis].remember(std::move(models));
  }

  /// Everything learned so far and all that the next sample meets, as bytes.
  std::string save() const;

  /// The model that was saved, which goes on to the last bit as if it had never stopped. `made` is
  /// one made as that one was and not used yet; it is used up. A machine with other vector
  /// instructions goes on as well, but rounds differently. Throws InputError naming inputs, targets
  /// or the setting that differ, with both values, or the part of the state that doesn't fit.
  static DynamicsModel resume(DynamicsModel made, std::string_view saved);

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

  void visit(Archive& archive);

  std::vector<std::string> input_names_;
  std::vector<std::string> target_names_;
  ModelSettings settings_;
  std::vector<DynamicsAxis> axes_;
  std::vector<Decision> decisions_;  ///< of the last update
};

}  // namespace kelpie
