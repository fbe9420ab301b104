// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// What the including node said of a sample.
enum class Verdict : std::uint8_t {
  accepted,     ///< taken into the buffer and trained on
  explained,    ///< turned away by eq. (9): close to a support vector and within the tube
  duplicate,    ///< turned away by eq. (10): close to a support vector with the same target
  invalid,      ///< turned away: a NaN or infinity, or the wrong number of inputs
  held_back,    ///< kept aside until the scale of the data is known; learned then
  crowded_out,  ///< turned away: the budget went on work that earlier samples had left
};

/// A value with what is known of its uncertainty.
struct Prediction {
  double value = 0.0;
  /// Ends of the interval that holds the truth of the next sample with the promised share; infinite
  /// where nothing is promised.
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  /// Share of the buffer's samples in a denser place (KernelDensity::novelty), 0 to 1; NaN where
  /// the learner can't tell.
  double novelty = std::numeric_limits<double>::quiet_NaN();
};

/// What happened to one sample on its way through the nodes.
struct Decision {
  Verdict verdict = Verdict::accepted;
  double predicted = 0.0;  ///< what the model in service said before this sample was learned
  bool had_model = false;  ///< whether a model was in service then; else `predicted` is a mean
  /// The interval around `predicted` that was in force before this sample was learned; infinite
  /// where nothing was promised.
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double similarity = 0.0;  ///< highest κ_SE to a sample in the buffer, before it was learned
  int outliers = 0;         ///< samples rejected as outliers at this step
  int forgotten = 0;        ///< samples that left because the buffer was full
  int released = 0;         ///< samples that left because they had lost their weight
  int iterations = 0;       ///< of the solver, all solves of this step together
  double kkt_gap = 0.0;     ///< after this step, in units of the standardised target
  bool served = false;      ///< whether the model trained now went into service (gap in tolerance)
  bool unserved = false;    ///< the training ended out of tolerance
  bool unfinished = false;  ///< the budget ran out; the next call goes on with the work
  int fallbacks = 0;        ///< solves in which the solver gave up and SMO took over
  bool changed = false;     ///< the vehicle was found to have changed: what was known is forgotten
  double changed_since = 0.0;  ///< when errors began to grow [s], where `changed`
  std::int64_t recalled = 0;   ///< the number of the past model taken up (ModelMemory), or 0
};

/// Totals since the start. Every accepted sample is in the buffer or in `outliers`, `forgotten` or
/// `released`; where a challenger takes over, `forgotten` counts how much smaller its buffer is.
struct Tally {
  std::int64_t accepted = 0;
  std::int64_t explained = 0;
  std::int64_t duplicate = 0;
  std::int64_t invalid = 0;
  std::int64_t outliers = 0;
  std::int64_t forgotten = 0;
  std::int64_t released = 0;
  std::int64_t unserved = 0;  ///< steps whose training ended out of tolerance
  std::int64_t crowded_out = 0;
  std::int64_t unfinished = 0;  ///< steps that ran out of their budget
  std::int64_t fallbacks = 0;   ///< solves that SMO had to take over
  std::int64_t suspicions = 0;  ///< challengers that were tried
  std::int64_t changes = 0;     ///< those of them that took over, and past models that did
  std::int64_t recalls = 0;     ///< those of the changes that took up a past model

  void add(const Decision& decision);  ///< Counts one step.
  void visit(Archive& archive);        ///< core/archive.hpp
};

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
};

/// One axis: samples in, a function out. The one interface that the proposed learner, its
/// variants and the baselines share.
class OnlineRegressor {
 public:
  virtual ~OnlineRegressor() = default;

  /// Learns from one sample. `t` is the time in seconds, never decreasing. Doesn't throw on data:
  /// the decision says what happened.
  virtual Decision update(std::span<const double> x, double y, double t) = 0;

  /// Tells that another axis of the same vehicle has found a change, errors having grown since then
  /// [s]; `another`: to a vehicle that it didn't know. Between two updates. By default nothing
  /// comes of it.
  virtual void alert(double /*since_s*/, bool /*another*/) {}

  /// The model's value at x. Requires as many inputs as it was made for.
  virtual double predict(std::span<const double> x) const = 0;

  /// predict() with what is known of its uncertainty. Requirements as there.
  virtual Prediction assess(std::span<const double> x) const { return {.value = predict(x)}; }

  virtual Status status() const = 0;

  /// The coefficients of the physics terms in the model in service; none where it has no terms.
  /// Allocates.
  virtual std::vector<Coefficient> coefficients() const { return {}; }

 protected:
  OnlineRegressor() = default;
  OnlineRegressor(const OnlineRegressor&) = default;
  OnlineRegressor(OnlineRegressor&&) = default;
  OnlineRegressor& operator=(const OnlineRegressor&) = default;
  OnlineRegressor& operator=(OnlineRegressor&&) = default;
};

}  // namespace kelpie
