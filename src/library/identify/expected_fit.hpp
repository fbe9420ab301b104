// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "identify/free_fit.hpp"
#include "identify/minimum_distance.hpp"
#include "identify/window_noise.hpp"
#include "kelpie/identify/planar_fit.hpp"

namespace kelpie {

/// The expected result of an identification after rows to come, by the windows, normal equations
/// and sandwich of the identification: the standard errors of the rows so far and of drives on top,
/// with the noise that the rows so far have in the windows (window_noise()).
class ExpectedFit {
 public:
  virtual ~ExpectedFit() = default;

  /// By the rows so far. Errors are the identification's, or the expected errors by window_noise()
  /// where larger: residuals of a short log are smaller than the errors of the log.
  virtual const ParameterFit& now() const = 0;
  /// After windows of drives on top. Estimates stay.
  virtual ParameterFit after(const WeakRows& drives) const = 0;

  /// Expected logarithm of the likelihood ratio [nats] of two changes of the parameters after the
  /// rows so far, if one change is true and the other's size is fitted, for the harder of the two
  /// cases: T-optimality (Atkinson & Fedorov 1975) for changes so small that they act linearly.
  /// Errors of the parameters before the change count. `first`, `second`: changes of all
  /// parameters.
  double evidence(const WeakRows& drives, const std::vector<double>& first,
                  const std::vector<double>& second) const;

 protected:
  /// The information of windows about all parameters.
  struct Information {
    Eigen::MatrixXd hessian;    ///< of half the distance to the free coefficients
    Eigen::MatrixXd gradients;  ///< covariance of the distance's gradient, without the misfit
  };
  virtual Information information(const WeakRows& drives) const = 0;

  double misfit_ = 1.0;
};

/// Of fit_planar().
class ExpectedPlanarFit : public ExpectedFit {
 public:
  /// Throws what fit_planar() throws, but goes on where a parameter is not told: a drive that tells
  /// the parameter is sought. A thruster that never ran in one direction counts as alike both ways.
  explicit ExpectedPlanarFit(const PlanarRows& rows);

  const PlanarFit& now() const override { return now_; }
  /// `drives`: weak_rows() of simulated rows.
  ParameterFit after(const WeakRows& drives) const override;

 private:
  Information information(const WeakRows& drives) const override;
  Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& scores,
                                const std::vector<Eigen::Index>& free) const;
  PlanarFit fit_of(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& scores,
                   const WeakRows& windows) const;

  std::vector<std::string> thrusters_;
  WeakRows weak_;
  FreeFit free_;  ///< of the rows so far, with the coefficients of the structure
  MinimumDistance best_;
  WindowNoise noise_;
  double factor_ = 1.0;  ///< on the variance: fit_planar()'s over that of the noise, at least 1
  PlanarFit now_;
};

/// The median of the ratios of the diagonals: of two estimates of a covariance.
double median_ratio(const Eigen::MatrixXd& above, const Eigen::MatrixXd& below);

}  // namespace kelpie
