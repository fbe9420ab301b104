// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include "kelpie/online/forgetting.hpp"
#include "kelpie/online/including_gate.hpp"
#include "kelpie/online/outlier_filter.hpp"
#include "kelpie/online/past_model.hpp"
#include "kelpie/online/regressor.hpp"
#include "kelpie/online/sample_collector.hpp"
#include "kelpie/online/settings.hpp"
#include "kelpie/svr/path_solver.hpp"
#include "kelpie/svr/smo_solver.hpp"
#include "kelpie/svr/svr_function.hpp"

namespace kelpie {

/// The paper's learner for one axis (Algorithm 1), on scaled inputs and a standardised target:
/// include, collect, train, reject outliers, forget, serve.
///
/// Real time: after construction update() and predict() allocate nothing, take no lock and throw
/// nothing. An update can be given a budget; when it runs out the model before stays in service and
/// the next update goes on with the work, before it learns a sample of its own. Memory: bytes(),
/// about (buffer + 1)² doubles, twice that with the path solver.
class OnlineSvr final : public OnlineRegressor {
 public:
  /// A sample is `inputs` scaled inputs followed by `terms` scaled physics terms. Throws InputError
  /// on settings that don't validate.
  OnlineSvr(std::size_t inputs, const OnlineSvrSettings& settings, std::size_t terms = 0);

  /// What every update from now on may spend; a default one never ends.
  void limit(const Budget& budget) { budget_ = budget; }

  /// One sample's way through the nodes. Cost: a few solver steps (PathSolver, SmoSolver).
  Decision update(std::span<const double> z, double y, double t) noexcept override;

  /// By the model in service; before there is one, the mean of the targets so far.
  double predict(std::span<const double> z) const noexcept override;

  Status status() const override;

  /// Goes over to another scale: puts all samples through the map and solves anew. Takes tens of
  /// milliseconds with a full buffer of 900, whatever the budget. Allocates nothing.
  void rescale(const SampleMap& map);

  /// Learns the samples of a past model, put through a map where there is one. Their times are
  /// shifted so that the latest of them is `now`: their ages go on from what they were when the
  /// model was kept. A slice of that work with every call, a fraction of a millisecond or less
  /// where the budget runs out; true once it is done. Requires a learner that has been cleared
  /// before the first call and not been touched since, the same arguments each time, and a model
  /// made for the same buffer. Allocates nothing.
  bool relearn_slice(const PastModel& past, double now, const SampleMap& map = {});

  /// Forgets everything, and learns them all at once.
  void relearn(const PastModel& past, double now);

  /// Forgets everything, as if it had just been made. Allocates nothing.
  void clear();

  /// core/archive.hpp. The budget isn't part of the state: grant it again.
  void visit(Archive& archive);

  const OnlineSvrSettings& settings() const { return settings_; }
  const SampleCollector& buffer() const { return buffer_; }

  /// The model in service: always within tolerance of its KKT conditions.
  const SvrFunction& model() const { return model_; }
  bool ready() const { return status_.ready; }     ///< Whether there is one.
  bool unfinished() const { return unfinished_; }  ///< Whether the last update left work undone.

  /// All memory of a learner in bytes, known before there is one. Requires settings that
  /// validate.
  static std::size_t bytes(std::size_t inputs, const OnlineSvrSettings& settings,
                           std::size_t terms = 0);

 private:
  /// A sample whose weight is on its way to 0, and where its leaving will be counted.
  struct Leaving {
    std::size_t sample = 0;
    int Decision::*count = nullptr;
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
  void collect_slice(const PastModel& past, std::size_t samples, double now, const SampleMap& map);
  double predicted(std::span<const double> z) const;

  OnlineSvrSettings settings_;
  IncludingGate gate_;
  SampleCollector buffer_;
  std::variant<PathSolver, SmoSolver> solver_;
  OutlierFilter filter_;
  Forgetting forgetting_;
  SvrFunction model_;
  SolveReport solved_{.converged = true};  ///< of the buffer as it stands
  Budget budget_;                          ///< of every update
  Budget left_;                            ///< of this update
  bool pruned_weight_ = false;             ///< a sample with a weight has left since the last solve
  bool unfinished_ = false;                ///< the last update ran out of its budget
  int waiting_ = 0;                        ///< samples taken meanwhile
  std::optional<Leaving> leaving_;         ///< whom it was about to remove
  bool current_ = false;    ///< the model in service is that of the buffer as it stands
  bool relearned_ = false;  ///< a past model's samples have been learned
  double mean_ = 0.0;       ///< of the valid targets, for the time before there is a model
  std::int64_t valid_samples_ = 0;
  Status status_;
};

}  // namespace kelpie
