// SPDX-License-Identifier: Apache-2.0
#include "identify/six_axis_windows.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace kelpie {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Differences for derivatives by the parameters of the curve.
constexpr std::array kNudge{0.005, 0.005, 0.005, 0.05};

// rows × thrusters.
Eigen::MatrixXd speeds_of(const SixAxisRows& rows, const ThrustCurve& curve) {
  const std::vector<double> speeds = thruster_speeds(rows, curve);
  return Eigen::Map<const RowMajor>(speeds.data(), place_of(rows.rows()),
                                    place_of(rows.thrusters.size()));
}

// Newtons of each thruster, rows × thrusters.
Eigen::MatrixXd thrusts_of(const Eigen::MatrixXd& speeds, const Eigen::VectorXd& parameters) {
  Eigen::MatrixXd thrusts = speeds.cwiseProduct(speeds.cwiseAbs());
  for (Eigen::Index i = 0; i < thrusts.cols(); ++i) {
    const Eigen::Index at = place_of(SixAxisPlace::thruster(static_cast<std::size_t>(i)));
    for (double& value : thrusts.col(i)) {
      value *= value > 0.0 ? parameters(at) : parameters(at + 1);
    }
  }
  return thrusts;
}

Eigen::MatrixXd plain_terms(const SixAxisRows& rows, const MotionTerms& terms,
                            const Eigen::MatrixXd& speeds) {
  const Eigen::Index count = place_of(rows.rows());
  Eigen::MatrixXd values(count, place_of(terms.size()));
  std::vector<double> inputs(9 + rows.thrusters.size());
  std::vector<double> row_terms(terms.size());
  for (Eigen::Index row = 0; row < count; ++row) {
    const auto at = static_cast<std::size_t>(row);
    std::copy_n(rows.velocities.begin() + static_cast<std::ptrdiff_t>(6 * at), 6, inputs.begin());
    std::copy_n(rows.down.begin() + static_cast<std::ptrdiff_t>(3 * at), 3, inputs.begin() + 6);
    for (std::size_t i = 0; i < rows.thrusters.size(); ++i) {
      inputs[9 + i] = speeds(row, place_of(i));
    }
    terms.evaluate(inputs, row_terms);
    values.row(row) = Eigen::Map<const Eigen::RowVectorXd>(row_terms.data(), values.cols());
  }
  return values;
}

// Derivatives of the forces on six axes by the parameters of the curve, rows × 24.
Eigen::MatrixXd curve_terms(const SixAxisRows& rows, const SixAxisWindows& windows,
                            const Eigen::VectorXd& parameters) {
  const Eigen::MatrixXd arms = thruster_arms(rows.thrusters);
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(place_of(rows.rows()), 24);
  for (std::size_t k = 0; k < kThrustCurve.size(); ++k) {
    if (!windows.sought[k]) {
      continue;
    }
    // NOLINTBEGIN(misc-const-correctness): changed by pointers to members
    ThrustCurve above = windows.curve;
    ThrustCurve below = windows.curve;
    // NOLINTEND(misc-const-correctness)
    above.*kThrustCurve[k] += kNudge[k];
    below.*kThrustCurve[k] = std::max(0.0, below.*kThrustCurve[k] - kNudge[k]);
    const Eigen::MatrixXd change = thrusts_of(speeds_of(rows, above), parameters) -
                                   thrusts_of(speeds_of(rows, below), parameters);
    values.middleCols(place_of(6 * k), 6) =
        change * arms.transpose() / (above.*kThrustCurve[k] - below.*kThrustCurve[k]);
  }
  return values;
}

EquationRows equation_of(const SixAxisRows& rows, Eigen::MatrixXd terms) {
  return {
      .times_s = rows.times_s,
      .starts = rows.starts,
      .velocities = Eigen::Map<const RowMajor>(rows.velocities.data(), place_of(rows.rows()), 6),
      .terms = std::move(terms)};
}

}  // namespace

WeakRows weak_rows(const SixAxisRows& rows, const SixAxisStructure& structure,
                   const SixAxisWindows& windows) {
  return weak_rows(
      equation_of(rows, plain_terms(rows, structure.terms(), speeds_of(rows, windows.curve))),
      windows.shape);
}

WeakRows weak_rows(const SixAxisRows& rows, const SixAxisStructure& structure,
                   const SixAxisWindows& windows, const Eigen::VectorXd& parameters) {
  const Eigen::MatrixXd plain =
      plain_terms(rows, structure.terms(), speeds_of(rows, windows.curve));
  Eigen::MatrixXd terms(plain.rows(), plain.cols() + 24);
  terms << plain, curve_terms(rows, windows, parameters);
  return weak_rows(equation_of(rows, std::move(terms)), windows.shape);
}

}  // namespace kelpie
