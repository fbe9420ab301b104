// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/roomy_vector.hpp"
#include "svr/dual_problem.hpp"
#include "svr/free_set.hpp"
#include "svr/tuning.hpp"
#include "svr/watch_list.hpp"

namespace kelpie {

/// The end of a straight move: no event, a free weight at its bound, or a watched residual at the
/// edge of the tube.
struct PathEvent {
  /// Change of the free set.
  enum class Kind : std::uint8_t { none, leaves, joins };
  Kind kind = Kind::none;
  double step = 0.0;
  std::size_t sample = 0;
  double weight = 0.0;           ///< leaves: the bound of β
  Branch branch = Branch::both;  ///< joins: its branch
};

/// Straight moves along the solution path: between two events weights, bias and residuals are
/// linear in the path parameter, and free samples stay on the edges of the tube. A path consists of
/// begin(), some moves and end(). During a path only the residuals of free and watched samples are
/// up to date. Allocates in the constructor only.
class PathMove {
 public:
  explicit PathMove(std::size_t capacity);  ///< Allocates for `capacity` samples.

  const FreeSet& free() const { return free_; }
  double bias() const { return bias_; }
  void set_bias(double bias) { bias_ = bias; }  ///< Sets b.

  /// Adds a sample to the free set (FreeSet::join).
  void join(const DualProblem& problem, std::size_t sample, Branch branch);
  /// Removes a sample from the free set (FreeSet::leave).
  void leave(const DualProblem& problem, std::size_t sample);
  /// FreeSet::renew_oldest.
  void renew_oldest(const DualProblem& problem) { free_.renew_oldest(problem.kernel()); }
  void renumber(std::size_t from, std::size_t to);  ///< Changes the number of a sample.
  void clear();                                     ///< Forgets all samples.

  /// Begins a path with the sample c at its head, or without a head (kNone). The head is not free,
  /// and its line of the table may be violated; so may lines violated by more than `slack`. Cost
  /// O(n).
  void begin(const DualProblem& problem, std::size_t c, double slack);

  /// Updates all residuals. Cost O(n) per changed weight.
  void refresh(DualProblem& problem);

  /// Ends the path and updates all residuals.
  void end(DualProblem& problem);

  /// Sets the direction with dβ_c = s (s = ±1). Requires a free sample. Returns de_c per unit. Cost
  /// O((|F| + watched) |F|).
  double head(const DualProblem& problem, double s);

  /// Sets the direction that moves the free samples to their edges and Σβ to 0 by a step of 1.
  /// Requires a free sample. Cost as head().
  void correction(const DualProblem& problem);

  /// The first event within the step `longest`. Cost O(|F| + watched).
  PathEvent first_event(const DualProblem& problem, double longest) const;

  /// Moves by the event's step and updates the free set.
  void apply(DualProblem& problem, const PathEvent& event);

  /// Work of a straight move and its event.
  std::size_t move_work() const {
    return free_.size() * (free_.size() + watch_.watched().size()) + kSvr.work_aside;
  }

  /// core/archive.hpp. Requires an ended path.
  void visit(Archive& archive, const DualProblem& problem);

  /// Memory in bytes, beside the object itself.
  static std::size_t bytes(std::size_t capacity);

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

 private:
  void rates();
  void watch_nearest(const DualProblem& problem);
  void watch(const DualProblem& problem, std::size_t sample);

  FreeSet free_;
  WatchList watch_;
  double bias_ = 0.0;
  double nearness_ = kSvr.nearness;  ///< distance from an edge up to which samples are watched
  double slack_ = 0.0;
  std::size_t head_ = kNone;

  // The present move: weights change by d_beta_ (by place), b by d_bias_.
  std::vector<double> d_beta_;
  std::vector<double> d_off_;  ///< change of off_edge()
  double d_bias_ = 0.0;
  double d_head_ = 0.0;          ///< change of the head's residual g
  double size_ = 0.0;            ///< Σ|d_beta|
  std::vector<double> spread_;   ///< d_beta_ laid out by sample
  std::vector<double> product_;  ///< K d_beta of the watched samples

  // The present path: samples with a changed weight, and their weights at its begin.
  RoomyVector<std::size_t> moved_;
  std::vector<double> weight_before_;
  std::vector<char> has_moved_;
  std::vector<double> change_;
};

/// e_i ∓ ε of a member of the free set, the distance from its edge: rounding only.
double off_edge(const DualProblem& problem, const PathMove& move, std::size_t place);

/// The branch of a sample at the lower edge of the tube (its weight may grow) or at the upper edge
/// (its weight may shrink).
Branch branch_at(const DualProblem& problem, std::size_t i, bool lower_edge);

/// Smallest and largest weight of a branch.
std::pair<double, double> weights_of(Branch branch, double c);

}  // namespace kelpie
