// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "kelpie/core/archive.hpp"
#include "kelpie/svr/decision.hpp"

namespace kelpie {

/// The state of a learner, for reports.
struct Status {
  int buffer = 0;           ///< samples in the buffer
  int support_vectors = 0;  ///< samples with a weight
  double kkt_gap = 0.0;     ///< of the model in service
  bool ready = false;       ///< a trained model is in service
  Tally tally{};

  void visit(Archive& archive);  ///< core/archive.hpp
};

/// The coefficient of a physics term, in target units per unit of the term.
struct Coefficient {
  std::string term;
  double value = 0.0;
  double error = std::numeric_limits<double>::quiet_NaN();  ///< standard error; NaN: unknown
};

/// The weight of a mixture's member: 0 to 1, with the sum 1.
struct MemberShare {
  std::string name;
  double share = 0.0;
};

/// A learner of one axis: samples in, a function out. The interface of the proposed learner, its
/// variants and the baselines.
class OnlineRegressor {
 public:
  virtual ~OnlineRegressor() = default;

  /// Learns from one sample. `t`: time [s], never decreasing. Does not throw on data; the decision
  /// reports the result.
  virtual Decision update(std::span<const double> x, double y, double t) = 0;

  /// Reports a change found on another axis of the vehicle, with the start of the grown errors
  /// `since_s` [s]. `another`: the vehicle is unknown on the other axis. To be called between two
  /// updates. No effect by default.
  virtual void alert(double /*since_s*/, bool /*another*/) {}

  /// Learns the held samples at once, for the end of a log.
  virtual void learn_held_back() {}

  /// The model's value at x. Requires the learner's number of inputs.
  virtual double predict(std::span<const double> x) const = 0;

  /// predict() with uncertainty. Requirements as predict().
  virtual Prediction assess(std::span<const double> x) const { return {.value = predict(x)}; }

  virtual Status status() const = 0;

  /// The coefficients of the physics terms in the model in service; empty without terms. Allocates.
  virtual std::vector<Coefficient> coefficients() const { return {}; }

  /// The members of a mixture; empty for a single learner. Allocates.
  virtual std::vector<MemberShare> members() const { return {}; }

 protected:
  OnlineRegressor() = default;
  OnlineRegressor(const OnlineRegressor&) = default;
  OnlineRegressor& operator=(const OnlineRegressor&) = default;
};

}  // namespace kelpie
