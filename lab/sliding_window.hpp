// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "kelpie/svr/settings.hpp"
#include "svr/path_solver.hpp"
#include "svr/sample_store.hpp"
#include "svr/smo_solver.hpp"
#include "svr/squared_exponential.hpp"

namespace kelpie::lab {

/// An ε-SVR over the last `buffer` samples of a stream, without further decisions on samples, so
/// that the times of solvers are comparable. Allocates in the constructor only.
class SlidingWindow {
 public:
  /// Uses the settings solver, storage, ridge, buffer, epsilon, c, gamma, tolerance,
  /// max_iterations.
  SlidingWindow(std::size_t inputs, const OnlineSvrSettings& settings);

  /// A whole update: kernel row, add, solve; with a full window also release and remove the oldest
  /// sample, and solve again. Returns the sum of the iterations, and gap and verdict of the last
  /// solve.
  SolveReport step(std::span<const double> z, double y);

  /// Continues with SMO from the present weights.
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
