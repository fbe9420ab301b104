// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "kelpie/learner/settings.hpp"
#include "svr/path_solver.hpp"
#include "svr/sample_store.hpp"
#include "svr/smo_solver.hpp"
#include "svr/squared_exponential.hpp"

namespace kelpie::lab {

/// One ε-SVR over the last `buffer` samples of a stream: the newest enters, the oldest leaves. No
/// node decides anything, so all solvers have the very same samples to work on, and their times
/// can be compared. Allocates in the constructor only.
class SlidingWindow {
 public:
  /// Of the settings, those of the problem and its solver count: solver, storage, ridge, buffer,
  /// epsilon, c, gamma, tolerance, max_iterations.
  SlidingWindow(std::size_t inputs, const OnlineSvrSettings& settings);

  /// A whole update: kernel row, add, solve; when the window was full also release and remove the
  /// oldest, and solve again. Returns all its solves as one report: iterations added up, gap and
  /// verdict of the last.
  SolveReport step(std::span<const double> z, double y);

  /// Goes on with warm-started SMO from the weights there are.
  void switch_to_smo();

  std::size_t size() const { return problem_.size(); }
  const SampleStore& samples() const { return samples_; }
  const DualProblem& problem() const { return problem_; }

  /// |F| of the path solver; 0 with SMO.
  std::size_t free_samples() const;

 private:
  Solver& solver();
  void remove_oldest(SolveReport& report);

  OnlineSvrSettings settings_;
  SquaredExponential kernel_;
  SampleStore samples_;
  DualProblem problem_;
  std::variant<PathSolver, SmoSolver> solver_;
  std::vector<double> row_;
  std::vector<std::uint64_t> arrival_;
  std::uint64_t next_arrival_ = 0;
};

}  // namespace kelpie::lab
