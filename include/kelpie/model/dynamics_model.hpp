// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/core/error.hpp"
#include "kelpie/model/dynamics_axis.hpp"
#include "kelpie/model/online_model.hpp"
#include "kelpie/model/settings.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/model/work_limit.hpp"
#include "kelpie/motion/diagnosis.hpp"

namespace kelpie {

/// The vehicle's dynamics, learned while it drives: accelerations (or any targets) from velocities,
/// commands, or any inputs, one learner per axis (eq. 3). update(), decisions() and axes() are
/// those of OnlineModel.
///
///     DynamicsModel model({"u", "v", "r", "th1", "th2", "th3"}, {"udot", "vdot", "rdot"},
///                         ModelSettings::from_preset("default", 3));
///     model.update(x, y, t);      // at every sample
///     model.predict(x, y);        // whenever a prediction is wanted
///
/// Spans of another size than asked for throw InputError, and nothing is written or learned. Where
/// a number of x isn't finite, a prediction is NaN, and so is its Jacobian; the interval is
/// infinite, the novelty 1. Several threads may predict at a time; an update needs the model for
/// itself, and update(), predict(), save() or trained() that come in between throw InputError.
/// SharedModel is for that.
class DynamicsModel final : public OnlineModel {
 public:
  /// The scaling is taken from the first samples. Throws InputError on settings that don't
  /// validate, no inputs or more than kMostInputs, no targets, or settings for another number.
  DynamicsModel(std::vector<std::string> inputs, std::vector<std::string> targets,
                const ModelSettings& settings);

  /// The scaling is given, one per target.
  DynamicsModel(std::vector<std::string> inputs, std::vector<std::string> targets,
                const ModelSettings& settings, std::span<const AxisScaling> scaling);

  /// What the solvers of every update may spend from now on; a default one never ends. Each solver
  /// of each axis (learner, challenger) has it for itself, so for a bound on the whole update give
  /// one whose `expired` compares a clock with a moment that you set before it. When it runs out
  /// the model before stays in service, and the next update goes on with the work before it takes
  /// a sample of its own. A new scale and a recall keep to it, but with `adapt = none`. It is no
  /// part of the saved state. Without it the work of an update is bounded all the same: WorkLimit.
  void limit(const Budget& budget) { budget_ = budget; }

  std::size_t inputs() const { return input_names_.size(); }

  /// The values at x, of inputs() numbers, into y, of axes(). Allocates nothing.
  void predict(std::span<const double> x, std::span<double> y) const;

  /// The same with the Jacobian, as TrainedModel::predict_with_jacobian. An axis without a model in
  /// service gives the mean of its targets so far, and zeros.
  void predict_with_jacobian(std::span<const double> x, std::span<double> y,
                             std::span<double> jacobian) const;

  /// The same with intervals and novelty, in the units of the log: where the next samples lie with
  /// the share `coverage` of the settings, if they are learned one after the other, and how new
  /// their place is to the buffer (docs/uncertainty.md); and with the disturbance of the sample
  /// that comes `ahead_s` [s] after the last one learned, by default the next
  /// (docs/disturbance.md). Cost: three kernel rows per axis. Allocates nothing.
  void predict(std::span<const double> x, std::span<Prediction> y, double ahead_s = 0.0) const;

  const DynamicsAxis& axis(std::size_t i) const override { return axes_[i]; }

  /// What has become of the vehicle, and how its thrusters do (docs/diagnosis.md); null where it
  /// isn't known which inputs are the velocities that the targets accelerate, or where the
  /// equations of motion would have more than kMostTerms terms. Times are the model's.
  const Diagnosis* diagnosis() const { return diagnosis_ ? &*diagnosis_ : nullptr; }
  std::vector<Finding> findings() const;  ///< Those of it by the log's clock. Allocates.

  /// The past models of an axis (docs/memory.md). Allocates.
  std::vector<StoredPastModel> past_models(std::size_t axis) const {
    return axes_[axis].past_models();
  }

  /// Gives an axis past models of an earlier run, to be taken up when their vehicle returns.
  /// Requires that nothing has been learned yet, inputs of the same number, order and units, no
  /// more models than the setting `memory`, samples in each, and finite numbers.
  void set_past_models(std::size_t axis, std::vector<StoredPastModel> models) {
    axes_[axis].set_past_models(std::move(models));
  }

  /// Everything learned so far and all that the next sample meets, as bytes.
  std::string save() const;

  /// The model that was saved, which goes on to the last bit as if it had never stopped. Requires a
  /// `fresh` model that has learned nothing, made with the same arguments as the saved one; move it
  /// in. A machine with other vector instructions goes on as well, but rounds differently. Throws
  /// InputError naming inputs, targets or the setting that differ, with both values, or the part of
  /// the state that doesn't fit.
  static DynamicsModel resume(DynamicsModel fresh, std::string_view saved);

  /// A model that goes on learning where a trained one stands, from the time `start_s` [s] on, with
  /// the same settings. Its predictions are at first those of the trained one, to the solver's
  /// tolerance; of the member `memory` to about its usual error. What a trained model doesn't hold
  /// begins anew: intervals, the disturbance, the steady part, past models, totals. Use save()
  /// where all of it is to go on. Throws InputError on settings with other terms than the model's.
  static DynamicsModel resume_from(const TrainedModel& trained, double start_s = 0.0);

  /// Whether every axis has a model in service.
  bool ready() const;

  /// A copy of the models in service. Requires ready().
  TrainedModel trained() const;

  /// Memory of the learners and intervals of all axes in bytes, known before there is a model.
  /// Scales, samples held back, steady parts and the diagnosis (a quarter of a megabyte for three
  /// axes and three thrusters) are not counted. Requires settings that validate.
  static std::size_t bytes(std::span<const std::string> inputs, const ModelSettings& settings);

 private:
  DynamicsModel(std::vector<std::string> inputs, std::vector<std::string> targets,
                ModelSettings settings, const AxisScaling* scaling);

  OnlineRegressor& learner(std::size_t i) override { return axes_[i]; }
  void require_inputs(std::span<const double> x) const override {
    require_size("x", x.size(), inputs());
  }
  bool behind(std::size_t i) const override { return axes_[i].svr().champion().unfinished(); }
  void grant(std::size_t i, std::size_t followers) override {
    axes_[i].limit(work_.grant(budget_, followers));
  }
  void learned(std::span<const double> x, std::span<const double> y, double t) override;
  void visit(Archive& archive);

  std::vector<std::string> input_names_;
  std::vector<std::string> target_names_;
  ModelSettings settings_;
  std::vector<DynamicsAxis> axes_;
  std::optional<Diagnosis> diagnosis_;
  Budget budget_;  ///< of every update
  WorkLimit work_{1, 1};
};

}  // namespace kelpie
