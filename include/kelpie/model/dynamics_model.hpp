// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/model/online_model.hpp"
#include "kelpie/model/settings.hpp"

namespace kelpie {

class Budget;  // kelpie/svr/resources.hpp
class Diagnosis;
class ModelAxis;
struct Coefficient;
struct Finding;
struct StoredPastModel;
struct TrainedModel;

/// The vehicle's dynamics, learned while it drives: accelerations (or any targets) from velocities,
/// commands, or any inputs, one learner per axis (eq. 3). reference/architecture.md shows steps of
/// update().
///
///     DynamicsModel model({"u", "v", "r", "th1", "th2", "th3"}, {"udot", "vdot", "rdot"},
///                         ModelSettings::from_preset("default", 3));
///     model.update(x, y, t);      // at every sample
///     model.predict(x, y);        // whenever a prediction is wanted
///
/// Spans of another size throw InputError; nothing is written or learned. At an x with a number
/// that isn't finite, predictions and Jacobian are NaN, the interval is infinite, the novelty 1.
/// Several threads may predict and save at a time. An update needs the model alone: calls during an
/// update throw InputError, but for decisions(), axis(), diagnosis(), mechanisms(), ready() and
/// copies, which belong to the updating thread; SharedModel is for concurrent use. A number of an
/// axis that there isn't throws InputError. Movable at the cost of a pointer; a model that was
/// moved from can only be assigned or destroyed. Copies are deep.
class DynamicsModel final : public OnlineModel {
 public:
  /// Throws InputError on settings that don't validate,
  /// no inputs or more than kMostInputs, no targets, two inputs or two targets of one name, or
  /// settings for another number of targets.
  DynamicsModel(std::vector<std::string> inputs, std::vector<std::string> targets,
                const ModelSettings& settings);

  /// With a given scaling, one per target, of `learner = svr`; throws InputError with another.
  DynamicsModel(std::vector<std::string> inputs, std::vector<std::string> targets,
                const ModelSettings& settings, std::span<const AxisScaling> scaling);

  DynamicsModel(const DynamicsModel& other);
  DynamicsModel(DynamicsModel&& other) noexcept;
  DynamicsModel& operator=(const DynamicsModel& other);
  DynamicsModel& operator=(DynamicsModel&& other) noexcept;
  ~DynamicsModel() override;

  /// Limits the work of the solvers in every later update; a default Budget never ends. Each solver
  /// of each axis has the budget for itself; to bound a whole update, give a budget whose `expired`
  /// compares a clock with a deadline set before the update. When the budget runs out, the previous
  /// model stays in service, and the next update continues the work before it takes a sample. Not
  /// part of the saved state. Without a budget, WorkLimit bounds the work of an update.
  void limit(const Budget& budget);

  std::size_t inputs() const;

  using OnlineModel::update;
  /// OnlineModel::update().
  void update(std::span<const double> x, std::span<const double> y, double t,
              const AxisDone& done) override;
  void learn_held_back() override;
  std::span<const Decision> decisions() const override;
  const OnlineRegressor& axis(std::size_t axis) const override;

  /// The values at x, of inputs() numbers, into y, of axes(). Allocates nothing.
  void predict(std::span<const double> x, std::span<double> y) const;

  /// Values and Jacobian, as TrainedModel::predict_with_jacobian. An axis without a model in
  /// service gives the mean of its targets so far, and zeros.
  void predict_with_jacobian(std::span<const double> x, std::span<double> y,
                             std::span<double> jacobian) const;

  /// Values with intervals, novelty and disturbance, in the units of the log: the interval holds
  /// the next sample with the share `coverage` of the settings, provided that samples are learned
  /// one after the other; the novelty compares x with the buffer (docs/method/uncertainty.md); the
  /// disturbance is predicted for a sample `ahead_s` [s] after the last learned sample, by default
  /// the next (docs/method/uncertainty.md). Cost: three kernel rows per axis. Allocates nothing.
  void predict(std::span<const double> x, std::span<Prediction> y, double ahead_s = 0.0) const;

  /// Changes of the vehicle with their causes, and the state of its thrusters (howto/diagnosis.md).
  /// Null where the inputs that the targets accelerate are unknown, or where the equations of
  /// motion would have more than kMostTerms terms. Times are the model's.
  const Diagnosis* diagnosis() const;
  std::vector<Finding> findings() const;  ///< The findings by the log's clock. Allocates.

  /// The past models of an axis (docs/method/posterior.md). Allocates.
  std::vector<StoredPastModel> past_models(std::size_t axis) const;

  /// Gives an axis past models of an earlier run, for recall when their vehicle returns. Requires
  /// that nothing has been learned yet, inputs of the same number, order and units, no more models
  /// than the setting `memory`, and finite numbers. Throws InputError on models of another learner.
  void set_past_models(std::size_t axis, std::vector<StoredPastModel> models);

  /// The whole state as bytes: everything learned, and every input of the next update, but past
  /// models that were given.
  std::string save() const;

  /// The saved model; continues to the last bit as if never stopped. Requires a `fresh` model that
  /// has learned nothing, made with the arguments of the saved model and given the same past
  /// models (set_past_models()); move it in. A machine with other vector instructions continues
  /// too, but rounds differently. Throws InputError with the inputs, targets or setting that
  /// differ, with both values, or the part of the state that doesn't fit.
  static DynamicsModel resume(DynamicsModel fresh, std::string_view saved);

  /// A model that continues to learn from a trained model, from the time `start_s` [s] on, with the
  /// settings of the trained model. The first predictions equal those of the trained model to about
  /// the usual error, with `learner = svr` to the solver's tolerance. Parts that a trained model
  /// doesn't hold start anew: intervals, disturbance, steady part, past models, totals; save()
  /// keeps them. Throws InputError on settings with other terms than the model's.
  static DynamicsModel resume_from(const TrainedModel& trained, double start_s = 0.0);

  bool ready() const;  ///< Whether every axis has a model: some ten samples.

  TrainedModel trained() const;  ///< A copy of the models. Requires ready().

  /// Memory of the learners and intervals of all axes in bytes, known before construction. Scales,
  /// held-back samples, steady parts and the diagnosis (a quarter of a megabyte for three axes and
  /// three thrusters) are not counted. Requires settings that validate.
  static std::size_t bytes(std::span<const std::string> inputs, const ModelSettings& settings);

  /// The mechanisms of an axis, for kelpie's own tools and tests (model/model_axis.hpp).
  const ModelAxis& mechanisms(std::size_t axis) const;

 private:
  friend void set_nominal(DynamicsModel& model, std::size_t axis,
                          std::span<const Coefficient> known);
  struct Parts;

  std::unique_ptr<Parts> parts_;  ///< never null, unless moved from
};

/// Gives an axis of a model coefficients of physics terms known beforehand, as of the vehicle's
/// equations of motion or of an earlier model, from which learning begins
/// (docs/method/posterior.md): terms by their text (TermSet::text()), `1` for the constant; terms
/// without a coefficient have 0. An empty list: nothing is known. Errors of coefficients are not
/// read. Without effect on a learner alone (`learner = svr`). Requires that nothing has been
/// learned yet. Throws InputError on an axis or term that the model does not have, a term given
/// twice, or a value that is not finite. Allocates.
void set_nominal(DynamicsModel& model, std::size_t axis, std::span<const Coefficient> known);

}  // namespace kelpie
