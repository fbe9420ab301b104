// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "kelpie/model/access_guard.hpp"
#include "kelpie/online/regressor.hpp"

namespace kelpie {

/// The clock of a model, which never goes back: where the stamps of its samples do (a clock that is
/// put right, another log), it stands still for that step and goes on from there.
class ModelClock {
 public:
  double at(double t);  ///< The model's time [s] of the sample stamped `t` [s].

  /// The stamp of a time of the model, by the clock of the latest sample.
  double stamp(double at) const { return at - offset_; }

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  double offset_ = 0.0;
  double last_ = -std::numeric_limits<double>::infinity();
};

/// All axes of one vehicle, a learner each, that learn the same samples: a DynamicsModel, or
/// baselines to compare it with (AxisList). The one way a sample takes to the learners is update().
class OnlineModel {
 public:
  /// Called with the axis that has just learned the sample, e.g. to take its time.
  using AxisDone = std::function<void(std::size_t)>;

  virtual ~OnlineModel() = default;

  std::size_t axes() const { return decisions_.size(); }

  /// Every axis learns from one sample, in turn; then those that found a change of the vehicle tell
  /// the others (OnlineRegressor::alert). What happened stands in decisions().
  /// x and y are in the units of the log. Of bad data (a number that isn't finite, a time that
  /// steps back: ModelClock) the decisions say what became; nothing is thrown. Throws InputError,
  /// and has learned nothing, on a y that isn't of axes() values, on an x that isn't of as many as
  /// a DynamicsModel has inputs (other learners call that Verdict::invalid), and where another
  /// thread uses the model at that moment.
  void update(std::span<const double> x, std::span<const double> y, double t,
              const AxisDone& done = {});

  /// Learns at once what is still held back of the first samples although the scale is known: for
  /// a log that ends there. Later updates learn a few of them each.
  void learn_held_back();

  /// What the last update() made of its sample, one per axis.
  std::span<const Decision> decisions() const { return decisions_; }

  /// The learner of an axis, to ask for predictions and its state.
  virtual const OnlineRegressor& axis(std::size_t i) const = 0;

 protected:
  /// For so many axes.
  explicit OnlineModel(std::size_t axes) : decisions_(axes) { turns_.reserve(axes); }
  OnlineModel(const OnlineModel&) = default;
  OnlineModel(OnlineModel&&) = default;
  OnlineModel& operator=(const OnlineModel&) = default;
  OnlineModel& operator=(OnlineModel&&) = default;

  ModelClock& clock() { return clock_; }  ///< For the state of a derived class.
  const ModelClock& clock() const { return clock_; }
  const AccessGuard& access() const { return access_; }

 private:
  /// Throws InputError on an x that the learners don't take.
  virtual void require_inputs(std::span<const double> /*x*/) const {}
  virtual OnlineRegressor& learner(std::size_t i) = 0;
  /// Whether an axis is still at work on the sample before, and so comes before the others.
  virtual bool behind(std::size_t /*i*/) const { return false; }
  /// An axis is about to learn the sample at hand, and so many others after it.
  virtual void grant(std::size_t /*i*/, std::size_t /*followers*/) {}
  /// All axes have learned this sample, whose time is the model's.
  virtual void learned(std::span<const double> /*x*/, std::span<const double> /*y*/, double /*t*/) {
  }
  void share_changes();
  void take_turns();

  std::vector<Decision> decisions_;
  std::vector<std::size_t> turns_;  ///< scratch: the axes as they learn the sample at hand
  ModelClock clock_;
  AccessGuard access_;
};

/// A model of any learners, one per axis.
class AxisList final : public OnlineModel {
 public:
  /// Requires that none is null.
  explicit AxisList(std::vector<std::unique_ptr<OnlineRegressor>> axes)
      : OnlineModel(axes.size()), axes_(std::move(axes)) {}
  /// Of one.
  explicit AxisList(std::unique_ptr<OnlineRegressor> axis) : OnlineModel(1) {
    axes_.push_back(std::move(axis));
  }

  const OnlineRegressor& axis(std::size_t i) const override { return *axes_[i]; }

 private:
  OnlineRegressor& learner(std::size_t i) override { return *axes_[i]; }

  std::vector<std::unique_ptr<OnlineRegressor>> axes_;
};

}  // namespace kelpie
