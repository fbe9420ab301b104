// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "alignment/alignment_fit.hpp"
#include "kelpie/alignment/alignment.hpp"
#include "motion/motion_terms.hpp"

namespace kelpie {

/// Places of the motion in the plane among inputs and targets.
struct PlanarPlaces {
  std::size_t surge = 0, sway = 0, yaw_rate = 0;  ///< inputs
  std::size_t surge_target = 0, sway_target = 0;  ///< targets
};

/// Fits of accelerations to velocities through the water and commands, with a current that is told
/// at some times ("knots"). The weights of the terms are eliminated (variable projection: Golub &
/// Pereyra 1973), the current takes Gauss-Newton steps (Kaufman 1975).
class CurrentFit {
 public:
  static constexpr std::size_t kFolds = 10;  ///< of blocks spread over the log

  /// `headings_rad`: ψ of every row in use. Keeps the rows it needs.
  CurrentFit(const AlignmentProblem& problem, const PlanarPlaces& places,
             std::span<const double> headings_rad);

  std::size_t rows() const { return fold_.size(); }   ///< Of a fit.
  std::size_t terms() const { return list_.size(); }  ///< MotionTerms::alignment

  /// The times of a current [s], evenly over the rows in use.
  std::vector<double> knots(std::size_t count) const;

  /// c₁, c₂ of every knot in turn, fitted to all rows. Begins at `start` (as many values); none
  /// for no knots. Cost: some five passes over the rows.
  Eigen::VectorXd fitted(const Eigen::VectorXd& start) const;

  /// Held-out errors over the variance of the target, in logarithms, fold × target, of fits that
  /// begin at `start`. Cost: ten times that of fitted().
  Eigen::ArrayXXd log_errors(const Eigen::VectorXd& start) const;

 private:
  using Rows = std::vector<Eigen::Index>;

  // The problem at a current: terms and accelerations of all rows.
  struct Water {
    Eigen::MatrixXd phi;  // term × row
    Eigen::MatrixXd y;    // target × row
  };
  // The least-squares fit to some rows.
  struct Weights {
    Eigen::MatrixXd of;         // term × target
    Eigen::MatrixXd projector;  // G⁻¹ Φ of the rows
    double squares = 0.0;       // errors, each in units of the target's usual error
  };

  Water through(const Eigen::VectorXd& current) const;
  Weights weights(const Water& water, const Rows& rows) const;
  std::vector<Eigen::MatrixXd> slopes(const Eigen::VectorXd& current, const Water& water,
                                      const Weights& weights) const;
  Eigen::VectorXd step(const Eigen::VectorXd& current, const Water& water, const Weights& weights,
                       const Rows& rows) const;
  Eigen::VectorXd descend(Eigen::VectorXd current, const Rows& rows) const;
  Eigen::MatrixXd penalty(Eigen::Index knots) const;

  PlanarPlaces places_;
  MotionTerms list_;
  Eigen::MatrixXd x_;         // input × row, in the units of the log
  Eigen::MatrixXd y_;         // target × row
  Eigen::ArrayXd t_;          // of every row [s]
  Eigen::ArrayXd cos_, sin_;  // of ψ
  Eigen::VectorXd scale_;     // of every term: its root mean square in still water
  Eigen::ArrayXd variance_;   // of every target
  Eigen::ArrayXd usual_;      // error of every target in still water [root mean square]
  std::vector<std::size_t> fold_;
  double information_ = 0.0;  // of a current, by all rows
};

}  // namespace kelpie
