// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "core/eigen.hpp"
#include "core/normal_equations.hpp"
#include "kelpie/alignment/alignment.hpp"
#include "motion/motion_terms.hpp"

namespace kelpie {

/// The rows in use of an AlignmentProblem by columns: clipped to the range of most values, widened
/// by half on either side, and divided by the largest value.
class AlignmentRows {
 public:
  explicit AlignmentRows(const AlignmentProblem& problem);  ///< Refers to the rows of the problem.

  std::size_t size() const { return rows_.size(); }

  /// The place in the log of the `i`-th row in use.
  std::size_t row(std::size_t i) const { return rows_[i]; }

  /// Seconds in the stretches of the rows in use.
  double duration_s() const;

  /// The row in use of the same stretch, nearest to `shift` rows of the log after the `i`-th.
  std::size_t shifted(std::size_t i, int shift) const;

  /// What the actuator makes of a command, `shift` rows later, for each row in use; by the largest
  /// value of the command. An actuator begins each stretch at rest.
  void effects(std::size_t command, int shift, const Actuator& actuator,
               std::span<double> effects) const;

  std::vector<std::vector<double>> inputs;   ///< [input][row in use]
  std::vector<std::vector<double>> targets;  ///< [target][row in use]
  std::vector<double> largest;               ///< [input], in the unit of the log
  std::vector<double> largest_target;        ///< [target], in the unit of the log

 private:
  std::span<const std::size_t> rows_;
  std::span<const double> times_s_;  // of all rows of the log
  double rate_hz_;
  std::vector<std::size_t> first_;  // of the stretch of each row in use
  std::vector<std::size_t> last_;
};

/// A guess at the alignment: the shift of all commands, and an actuator per command.
struct AlignmentGuess {
  int shift = 0;
  std::vector<Actuator> actuators;

  /// The guess that an alignment is, in rows as found; of as many commands.
  static AlignmentGuess of(const Alignment& alignment, std::size_t commands);

  bool operator==(const AlignmentGuess&) const = default;
};

/// Held-out errors of fits of accelerations to velocities and commands under a guess. Errors are
/// divided by the variance of the target, in logarithms.
class AlignmentFit {
 public:
  static constexpr std::size_t kFolds = 10;  ///< contiguous
  static constexpr std::size_t kParts = 5;   ///< of the log, for the kernel

  /// `commands`: places of the shifted inputs. Keeps a reference to `rows`.
  AlignmentFit(const AlignmentRows& rows, const std::vector<std::size_t>& commands);

  const AlignmentRows& rows() const { return rows_; }
  const std::vector<std::size_t>& commands() const { return commands_; }
  std::size_t terms() const { return list_.size(); }  ///< MotionTerms::alignment

  /// Least squares on the terms, fitted to nine folds and scored on the tenth: fold × target.
  /// Cost: one fit to at most 5,000 rows.
  Eigen::ArrayXXd log_errors(const AlignmentGuess& guess);

  /// Rows of the log in use that the fits of log_errors() explain to Alignment::unexplained of
  /// tuning.hpp: without wild velocities, which no alignment explains. Cost: as log_errors(), and
  /// a prediction for each row.
  std::vector<std::size_t> explained_rows(const AlignmentGuess& guess);

  /// Mean error of kernel ridge regression, which also follows motion outside the terms, on a few
  /// rows of each fifth of the log, so that a change of the vehicle affects one fifth only: fifth
  /// × 1. Cost: 25 fits to 240 rows.
  Eigen::ArrayXXd log_kernel_errors(const AlignmentGuess& guess);

 private:
  struct Effect {  // of a command, as last asked for
    int shift = 0;
    Actuator actuator{};
    std::vector<double> values;
  };
  struct HeldOut {                              // of the fits to all folds but one
    std::vector<Eigen::MatrixXd> coefficients;  // [fold]: term × target
    Eigen::ArrayXXd errors;                     // fold × target: mean squares
    Eigen::ArrayXd variance;                    // of the targets, over all folds
  };
  void take(const AlignmentGuess& guess);
  HeldOut held_out() const;
  NormalEquations sums_of(std::size_t fold) const;
  double log_kernel_error(std::span<const std::size_t> rows) const;
  Eigen::MatrixXd kernel_of(std::span<const std::size_t> rows) const;
  void fill(std::size_t row, std::span<double> x, Eigen::Ref<Eigen::VectorXd> phi) const;

  const AlignmentRows& rows_;
  std::size_t every_;  // rows are thinned where there are very many
  std::vector<std::size_t> states_;
  std::vector<std::size_t> commands_;
  std::vector<Effect> effects_;  // per command
  MotionTerms list_{0, {}};
};

}  // namespace kelpie
