// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "kelpie/svr/dual_problem.hpp"
#include "kelpie/svr/free_set.hpp"
#include "kelpie/svr/watch_list.hpp"
#include "svr/tuning.hpp"

namespace kelpie {

/// What stops a straight move first: nothing, a free weight that meets its end, or a watched
/// residual that meets the edge of the tube.
struct PathEvent {
  /// What happens to the sample.
  enum class Kind : std::uint8_t { none, leaves, joins };
  Kind kind = Kind::none;
  double step = 0.0;
  std::size_t sample = 0;
  double weight = 0.0;           ///< leaves: the end its β has met
  Branch branch = Branch::both;  ///< joins: its branch
};

/// The free samples and b, and the straight moves that keep them on the edges of the tube: between
/// two events everything on the solution path is linear. A path is begun, followed through some
/// moves and ended; while it lasts, only the residuals of free and watched samples are kept up to
/// date. Allocates in the constructor only.
class PathMove {
 public:
  explicit PathMove(std::size_t capacity);  ///< Allocates for so many samples.

  const FreeSet& free() const { return free_; }
  double bias() const { return bias_; }
  void set_bias(double bias) { bias_ = bias; }  ///< Sets b.

  /// A sample becomes free; as FreeSet::join.
  void join(const DualProblem& problem, std::size_t sample, Branch branch);
  /// A sample is free no longer; as FreeSet::leave.
  void leave(const DualProblem& problem, std::size_t sample);
  /// As FreeSet::renew_oldest.
  void renew_oldest(const DualProblem& problem) { free_.renew_oldest(problem.kernel()); }
  void renumber(std::size_t from, std::size_t to);  ///< A sample's number has changed.
  void clear();                                     ///< Forgets all samples.

  /// Begins a path, with c at its head unless it is kNone: c isn't free, and its line of the
  /// table is not looked after. Lines violated by more than `slack` aren't either. Cost O(n).
  void begin(const DualProblem& problem, std::size_t c, double slack);

  /// Brings all residuals up to date. Cost O(n) for every weight that has changed.
  void refresh(DualProblem& problem);

  /// Ends the path, all residuals up to date.
  void end(DualProblem& problem);

  /// e_i − (± ε) of a member of the free set: 0 but for rounding.
  double off_edge(const DualProblem& problem, std::size_t place) const;

  /// The direction in which β_c grows by s per unit (s = ±1). Requires a free sample. Returns by
  /// how much e_c changes per unit. Cost O((|F| + watched) |F|).
  double head(const DualProblem& problem, double s);

  /// The direction that takes all free samples to their edges and Σβ to 0 with a step of 1.
  /// Requires a free sample. Cost as above.
  void correction(const DualProblem& problem);

  /// The first event within `longest`. Cost O(|F| + watched).
  PathEvent first_event(const DualProblem& problem, double longest) const;

  /// Moves by the event's step and changes the free set accordingly.
  void apply(DualProblem& problem, const PathEvent& event);

  /// Numbers that a straight move with its event looks at.
  std::size_t move_work() const {
    return free_.size() * (free_.size() + watch_.watched().size()) + kSvr.work_aside;
  }
  /// And a path among n samples beside its moves.
  std::size_t path_work(std::size_t n) const {
    return free_.size() * (free_.size() + n) + kSvr.work_aside;
  }
  /// And what leave(), half of renew_oldest() or of correction() do.
  std::size_t factor_work() const { return free_.size() * free_.size(); }

  /// core/archive.hpp. Requires that no path is under way.
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
  double nearness_ = kSvr.nearness;  ///< how far from an edge samples are watched
  double slack_ = 0.0;
  std::size_t head_ = kNone;

  // The move at hand: weights change by d_beta_ (by place, the head's last), b by d_bias_.
  std::vector<double> d_beta_;
  std::vector<double> d_off_;  ///< how off_edge changes
  double d_bias_ = 0.0;
  double d_head_ = 0.0;          ///< how g of the head changes
  double size_ = 0.0;            ///< Σ|d_beta|
  std::vector<double> spread_;   ///< d_beta_ laid out by sample
  std::vector<double> product_;  ///< K d_beta of the watched

  // The path at hand: whose weight has changed since it began, and from where.
  std::vector<std::size_t> moved_;
  std::vector<double> weight_before_;
  std::vector<char> has_moved_;
  std::vector<double> change_;
};

/// The branch of a sample that stands at the lower edge of the tube for its weight (it may grow
/// from here) or the upper one (it may shrink).
Branch branch_at(const DualProblem& problem, std::size_t i, bool lower_edge);

/// The weights a branch allows.
std::pair<double, double> weights_of(Branch branch, double c);

}  // namespace kelpie
