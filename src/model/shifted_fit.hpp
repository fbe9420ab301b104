// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "core/normal_equations.hpp"
#include "kelpie/model/alignment_rows.hpp"
#include "motion/motion_terms.hpp"

namespace kelpie {

/// How well accelerations follow from velocities and shifted commands: held-out errors of fits with
/// one shift after the other. Errors are over the target's variance, in logarithms.
class AlignmentFit {
 public:
  static constexpr std::size_t kFolds = 5;  ///< contiguous

  /// `commands`: places of the inputs that are shifted. Requires that `rows` outlive it.
  AlignmentFit(const AlignmentRows& rows, const std::vector<std::size_t>& commands);

  std::size_t terms() const { return list_.size(); }  ///< x, x|x|, products of velocities, 1

  /// By least squares on the terms, fitted to four folds and judged on the fifth: fold × target.
  /// Cost: one fit to at most 20,000 rows.
  Eigen::ArrayXXd log_errors(int shift) const;

  /// By kernel ridge regression, which can follow what no term describes, on a few rows of each
  /// fifth of the log (a vehicle that changes on the way can't blur it): the mean.
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
