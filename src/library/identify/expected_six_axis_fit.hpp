// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "identify/expected_fit.hpp"
#include "identify/six_axis_fit.hpp"
#include "identify/six_axis_structure.hpp"
#include "identify/six_axis_windows.hpp"

namespace kelpie {

/// Of fit_six_axes(), with the length of windows of the rows so far, and with the effects of errors
/// of the velocity log and of the attitude on the fit of these rows.
class ExpectedSixAxisFit : public ExpectedFit {
 public:
  /// Throws as fit_six_axes() does. A thruster that ran in one direction only counts as alike both
  /// ways.
  explicit ExpectedSixAxisFit(const SixAxisRows& rows, const SixAxisSettings& options = {});

  const SixAxisFit& now() const override { return now_; }
  /// Cost: windows × (60 + 2 thrusters)² × lags. Allocates.
  ParameterFit after(const WeakRows& drives) const override;
  /// The windows of rows to come. Requires the same thrusters.
  WeakRows windows(const SixAxisRows& drives) const;

 private:
  Information information(const WeakRows& drives) const override;
  Information information(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& terms) const;
  Eigen::MatrixXd covariance_of(const Information& told) const;

  SixAxisFit now_;
  SixAxisStructure structure_;
  SixAxisWindows windows_;
  Eigen::VectorXd parameters_;  ///< with those of the thrust curve 0, as the structure takes them
  WindowNoise noise_;           ///< scaled to the errors of the rows so far, where larger
  /// A matrix per axis, terms × parameters: derivatives of the residual (StructureResidual), the
  /// same in the metric N⁻¹ of the residuals M ν̇ − Θ f, and N⁻¹ M.
  std::vector<Eigen::MatrixXd> slopes_, weighted_, by_scores_;
  Information told_;       ///< by the rows so far
  Eigen::MatrixXd floor_;  ///< covariance by errors that no log shows
};

}  // namespace kelpie
