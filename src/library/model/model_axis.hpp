// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/core/scaling.hpp"
#include "kelpie/model/settings.hpp"
#include "kelpie/model/stored_past_model.hpp"
#include "kelpie/motion/term_set.hpp"
#include "kelpie/svr/regressor.hpp"
#include "kelpie/svr/resources.hpp"
#include "model/command_gain.hpp"
#include "model/snapshot.hpp"

namespace kelpie {

/// One axis of a DynamicsModel, whatever learns: a regressor on raw samples with copies of the
/// model in service for others. Steps of an update, states and exceptions are those of
/// DynamicsModel.
class ModelAxis : public OnlineRegressor {
 public:
  virtual std::unique_ptr<ModelAxis> clone() const = 0;
  virtual void limit(const Budget& budget) = 0;  ///< Of the next update.
  virtual bool unfinished() const = 0;           ///< Work of earlier samples is left.
  virtual bool trusted_last() const = 0;         ///< The last sample was none of garbage.

  using OnlineRegressor::assess;
  virtual Prediction assess(std::span<const double> x, double ahead_s) const = 0;
  virtual double predict_with_gradient(std::span<const double> x,
                                       std::span<double> gradient) const = 0;

  virtual const TermSet& terms() const = 0;
  virtual const AxisScaling* scaling() const = 0;  ///< Null while the scale is not known.

  /// A copy of the model in service with all its uncertainty, and room to refresh() it for good.
  /// Allocates.
  virtual Snapshot snapshot() const = 0;
  /// Brings a copy of this axis up to date. Requires a model in service. Allocates nothing.
  virtual void refresh(Snapshot& copy) const = 0;
  /// A copy for a TrainedModel, without a disturbance. Requires a model in service. Allocates.
  virtual Snapshot trained(std::string name) const = 0;

  /// The vehicle has changed, for a learner that follows. `gains`: all that was learned holds for
  /// the commands times these factors; if empty, `step` of the coefficients of the first terms, the
  /// last number of the term 1 [target unit per unit of the term].
  virtual void apply_change(std::span<const CommandGain> /*gains*/,
                            std::span<const double> /*step*/, const Decision& /*news*/) {}
  virtual void expect_vehicle(std::vector<double> coefficients) = 0;
  virtual std::vector<StoredPastModel> past_models() const { return {}; }
  virtual void set_past_models(std::vector<StoredPastModel> models) = 0;
  virtual void resume_from(const Snapshot& trained, double t) = 0;

  virtual void visit(Archive& archive) = 0;  ///< core/archive.hpp
};

/// The axis of the learner in the settings. `states`: places of the velocities among the inputs, in
/// the order of the targets; none where unknown. Throws InputError on settings of the axis that
/// don't validate, and on a scaling for `learner = posterior`, which takes none. Requires valid
/// shared settings, inputs <= kMostInputs, and terms and scaling of these inputs.
std::unique_ptr<ModelAxis> make_axis(std::size_t inputs, const SharedSettings& shared,
                                     const OnlineSvrSettings& settings, const TermSet& terms,
                                     std::span<const std::size_t> states,
                                     std::optional<AxisScaling> scaling = {});

/// The axes of a model, in the order of the targets. Copies are deep.
class ModelAxes {
 public:
  ModelAxes() = default;
  ~ModelAxes() = default;
  ModelAxes(ModelAxes&&) noexcept = default;
  ModelAxes& operator=(ModelAxes&&) noexcept = default;
  ModelAxes(const ModelAxes& other) {
    for (const std::unique_ptr<ModelAxis>& axis : other.axes_) {
      axes_.push_back(axis->clone());
    }
  }
  ModelAxes& operator=(const ModelAxes& other) { return *this = ModelAxes(other); }

  void add(std::unique_ptr<ModelAxis> axis) { axes_.push_back(std::move(axis)); }
  std::size_t size() const { return axes_.size(); }
  ModelAxis& operator[](std::size_t i) const { return *axes_[i]; }

 private:
  std::vector<std::unique_ptr<ModelAxis>> axes_;
};

}  // namespace kelpie
