// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "kelpie/svr/regressor.hpp"
#include "kelpie/svr/settings.hpp"

namespace kelpie {

class Budget;  // kelpie/svr/resources.hpp
class SampleCollector;
class Solver;
class SvrFunction;
struct PastModel;

/// The paper's learner for one axis (Algorithm 1), on scaled inputs and a standardised target:
/// include, collect, train, reject outliers, forget, publish.
///
/// Real time: after construction update() and predict() allocate nothing, take no lock and throw
/// nothing. A budget limits an update; when the budget runs out, the former model stays in service
/// and the next update first continues the work. Memory: bytes(), about (buffer + 1)² doubles, and
/// twice as much with the path solver.
class OnlineSvr final : public OnlineRegressor {
 public:
  /// A sample consists of `inputs` scaled inputs and `terms` scaled physics terms, in this order.
  /// Throws InputError on settings that do not validate.
  OnlineSvr(std::size_t inputs, const OnlineSvrSettings& settings, std::size_t terms = 0);
  OnlineSvr(const OnlineSvr& other);
  OnlineSvr(OnlineSvr&& other) noexcept;
  /// Allocates nothing between learners of the same inputs, terms and settings.
  OnlineSvr& operator=(const OnlineSvr& other);
  OnlineSvr& operator=(OnlineSvr&& other) noexcept;
  ~OnlineSvr() override;

  /// Sets the budget of every further update; a default budget is unlimited.
  void limit(const Budget& budget);

  /// Passes one sample through the nodes. Cost: a few solver steps (PathSolver, SmoSolver).
  Decision update(std::span<const double> z, double y, double t) noexcept override;

  /// The value of the model in service; before the first model the mean of the targets.
  double predict(std::span<const double> z) const noexcept override;

  Status status() const override;

  /// Learns the samples of a past model in slices: each call does a fraction of a millisecond of
  /// work, less under a budget, and returns true after the last slice. Times are shifted to give
  /// the latest sample the time `now`. Requires clear() before the first call, no other call until
  /// the last, equal arguments in each, and a past model of an equal buffer. Allocates nothing.
  bool relearn_slice(const PastModel& past, double now);

  /// Forgets everything and learns the samples of a past model in one call.
  void relearn(const PastModel& past, double now);

  /// Forgets everything and returns to the state after construction. Allocates nothing.
  void clear();

  /// core/archive.hpp. The budget is no part of the state: grant the budget again.
  void visit(Archive& archive);

  const OnlineSvrSettings& settings() const { return settings_; }
  const SampleCollector& buffer() const;

  /// The model in service, always within tolerance of its KKT conditions.
  const SvrFunction& model() const;
  bool ready() const { return progress_.status.ready; }  ///< Whether a model is in service.
  /// Whether the last update left work undone.
  bool unfinished() const { return progress_.unfinished; }

  /// Memory of a learner in bytes, known before construction. Requires settings that validate.
  static std::size_t bytes(std::size_t inputs, const OnlineSvrSettings& settings,
                           std::size_t terms = 0);

 private:
  struct Nodes;
  struct Progress {
    bool pruned_weight = false;  ///< a sample with a weight has left since the last solve
    bool unfinished = false;     ///< the last update exhausted its budget
    int waiting = 0;             ///< samples collected since then, not yet learned
    bool current = false;        ///< the model in service is the model of the present buffer
    bool relearned = false;      ///< the samples of a past model have been learned
    double mean = 0.0;           ///< of the valid targets, the prediction before the first model
    std::int64_t valid_samples = 0;
    Status status;
  };

  void include(Decision& decision, std::span<const double> z, double y, double t);
  void learn(Decision& decision, double now);
  void train(Decision& decision);
  void reject(Decision& decision);
  void forget(Decision& decision, double now);
  void repair(Decision& decision);
  void publish(Decision& decision);
  bool remove(Decision& decision, std::size_t i, int Decision::*count);
  Solver& solver();
  void count(Decision& decision);
  void visit_leaving(Archive& archive);
  bool release_slice();
  void warm_start(const SvrFunction& function);
  void collect_slice(const PastModel& past, std::size_t samples, double now);
  double predicted(std::span<const double> z) const;

  OnlineSvrSettings settings_;
  /// Buffer, solver, model in service, and the nodes of Algorithm 1.
  std::unique_ptr<Nodes> nodes_;
  Progress progress_;
};

}  // namespace kelpie
