// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "core/normal_equations.hpp"
#include "kelpie/model/alignment.hpp"
#include "motion/motion_terms.hpp"

namespace kelpie {

/// The rows in use of an AlignmentProblem by columns: clipped to the range of most values, widened
/// by half on either side, and divided by the largest value.
class AlignmentRows {
 public:
  explicit AlignmentRows(const AlignmentProblem& problem);  ///< Refers to the rows of the problem.

  std::size_t size() const { return rows_.size(); }

  /// The row in use of the same stretch, nearest to `shift` rows of the log after the `i`-th.
  std::size_t shifted(std::size_t i, int shift) const;

  std::vector<std::vector<double>> inputs;   ///< [input][row in use]
  std::vector<std::vector<double>> targets;  ///< [target][row in use]

 private:
  std::span<const std::size_t> rows_;
  std::vector<std::size_t> first_;  // of the stretch of each row in use
  std::vector<std::size_t> last_;
};

/// Held-out errors of fits of accelerations to velocities and commands, for any shift of the
/// commands. Errors are divided by the variance of the target, in logarithms.
class AlignmentFit {
 public:
  static constexpr std::size_t kFolds = 5;  ///< contiguous

  /// `commands`: places of the shifted inputs. Keeps a reference to `rows`.
  AlignmentFit(const AlignmentRows& rows, const std::vector<std::size_t>& commands);

  std::size_t terms() const { return list_.size(); }  ///< x, x|x|, products of velocities, 1

  /// Least squares on the terms, fitted to four folds and scored on the fifth: fold × target.
  /// Cost: one fit to at most 20,000 rows.
  Eigen::ArrayXXd log_errors(int shift) const;

  /// Mean error of kernel ridge regression, which also follows motion outside the terms, on a few
  /// rows of each fifth of the log, so that a change of the vehicle affects one fifth only.
  /// Cost: 25 fits to 240 rows.
  double log_kernel_error(int shift) const;

 private:
  NormalEquations sums_of(std::size_t fold, int shift) const;
  double log_kernel_error(std::span<const std::size_t> rows, int shift) const;
  Eigen::MatrixXd kernel_of(std::span<const std::size_t> rows, int shift) const;
  void fill(std::size_t row, std::size_t from, std::span<double> x,
            Eigen::Ref<Eigen::VectorXd> phi) const;

  const AlignmentRows& rows_;
  std::size_t every_;  // rows are thinned where there are very many
  std::vector<std::size_t> states_;
  std::vector<std::size_t> commands_;
  MotionTerms list_{0, {}};
};

}  // namespace kelpie
