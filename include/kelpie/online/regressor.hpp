// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "kelpie/core/archive.hpp"
#include "kelpie/online/decision.hpp"
#include "kelpie/online/tally.hpp"

namespace kelpie {

/// The state of a learner as a report shows it.
struct Status {
  int buffer = 0;           ///< samples in the buffer
  int support_vectors = 0;  ///< those of them with a weight
  double kkt_gap = 0.0;     ///< of the model in service
  bool ready = false;       ///< whether a trained model is in service
  Tally tally{};

  void visit(Archive& archive);  ///< core/archive.hpp
};

/// What a model says of one physics term: target units per unit of the term.
struct Coefficient {
  std::string term;
  double value = 0.0;
  double error = std::numeric_limits<double>::quiet_NaN();  ///< standard error; NaN: not known
};

/// How much one member of a committee is believed: 0 to 1, all together 1.
struct MemberShare {
  std::string name;
  double share = 0.0;
};

/// One axis: samples in, a function out. The one interface that the proposed learner, its
/// variants and the baselines share.
class OnlineRegressor {
 public:
  virtual ~OnlineRegressor() = default;

  /// Learns from one sample. `t` is the time in seconds, never decreasing. Doesn't throw on data:
  /// the decision says what happened.
  virtual Decision update(std::span<const double> x, double y, double t) = 0;

  /// Another axis of the same vehicle has found a change; its errors began to grow at `since_s`
  /// [s]. `another`: the vehicle is none that it knew. To be called between two updates. Does
  /// nothing by default.
  virtual void alert(double /*since_s*/, bool /*another*/) {}

  /// Learns at once what it has held back so far, for the end of a log.
  virtual void learn_held_back() {}

  /// The model's value at x. Requires as many inputs as it was made for.
  virtual double predict(std::span<const double> x) const = 0;

  /// predict() with what is known of its uncertainty. Requirements as there.
  virtual Prediction assess(std::span<const double> x) const { return {.value = predict(x)}; }

  virtual Status status() const = 0;

  /// The coefficients of the physics terms in the model in service; none where it has no terms.
  /// Allocates.
  virtual std::vector<Coefficient> coefficients() const { return {}; }

  /// The members that it is made of; none where it is one learner. Allocates.
  virtual std::vector<MemberShare> members() const { return {}; }

 protected:
  OnlineRegressor() = default;
  OnlineRegressor(const OnlineRegressor&) = default;
  OnlineRegressor(OnlineRegressor&&) = default;
  OnlineRegressor& operator=(const OnlineRegressor&) = default;
  OnlineRegressor& operator=(OnlineRegressor&&) = default;
};

}  // namespace kelpie
