// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "kelpie/svr/dual_problem.hpp"
#include "kelpie/svr/free_set.hpp"

namespace kelpie {

/// What stops a straight move first: nothing, a free weight that meets its end, or a residual that
/// meets the edge of the tube.
struct PathEvent {
  enum class Kind : std::uint8_t { none, leaves, joins };
  Kind kind = Kind::none;
  double step = 0.0;
  std::size_t sample = 0;
  double weight = 0.0;           ///< leaves: the end its β has met
  Branch branch = Branch::both;  ///< joins: its branch
};

/// The free samples and b, and the straight moves that keep them on the edges of the tube: between
/// two events everything on the solution path is linear. Allocates in the constructor only.
class PathMove {
 public:
  explicit PathMove(std::size_t capacity);

  FreeSet& free() { return free_; }
  const FreeSet& free() const { return free_; }
  double bias() const { return bias_; }
  void set_bias(double bias) { bias_ = bias; }

  /// e_i − (± ε) of a member of the free set: 0 but for rounding.
  double off_edge(const DualProblem& problem, std::size_t place) const;

  /// The direction in which β_c grows by s per unit (s = ±1). Requires free().aim(c), a free
  /// sample. Returns by how much e_c changes per unit. Cost O(n min(|F|, n − |F|) + |F|²).
  double head(const DualProblem& problem, std::size_t c, double s);

  /// The direction that takes all free samples to their edges and Σβ to 0 with a step of 1.
  /// Requires a free sample. Cost as above.
  void correction(const DualProblem& problem);

  /// The first event within `longest`. Lines of the table that are violated by more than `slack`
  /// are not looked after. `apart`: a sample that is not looked after either. Cost O(n).
  PathEvent first_event(const DualProblem& problem, double longest, double slack,
                        std::size_t apart) const;

  /// Moves by the event's step and changes the free set accordingly.
  void apply(DualProblem& problem, const PathEvent& event);

  static constexpr std::size_t kNobody = static_cast<std::size_t>(-1);

 private:
  void rates(const DualProblem& problem);

  FreeSet free_;
  double bias_ = 0.0;
  // The move at hand: the weights of who_ change by d_beta_, b by d_bias_, g by d_gradient_.
  std::vector<std::size_t> who_;
  std::vector<double> d_beta_;
  std::vector<double> d_free_residual_;
  double d_bias_ = 0.0;
  double size_ = 0.0;  ///< Σ|d_beta|
  std::vector<double> d_gradient_;
  std::vector<double> spread_;  ///< d_beta_ laid out by sample
};

/// The branch of a sample that stands at the lower edge of the tube for its weight (it may grow
/// from here) or the upper one (it may shrink).
Branch branch_at(const DualProblem& problem, std::size_t i, bool lower_edge);

/// The weights a branch allows.
std::pair<double, double> weights_of(Branch branch, double c);

}  // namespace kelpie
