// SPDX-License-Identifier: Apache-2.0
#include "motion/minimum_distance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/normal_equations.hpp"
#include "motion/cone_program.hpp"
#include "motion/tuning.hpp"

namespace kelpie {
namespace {

constexpr int kMostSteps = 25;
constexpr double kConverged = 1e-9;
constexpr double kParameterRidge =
    1e-12;  // so that what the log doesn't tell has a finite, huge error

Eigen::VectorXd chosen(const Eigen::VectorXd& values, const std::vector<Eigen::Index>& places) {
  return values(places);
}

// Where parameters are among the free ones.
std::vector<Eigen::Index> places_in(const std::vector<Eigen::Index>& free,
                                    std::span<const Eigen::Index> parameters) {
  std::vector<Eigen::Index> places;
  for (const Eigen::Index parameter : parameters) {
    const auto found = std::ranges::find(free, parameter);
    if (found != free.end()) {
      places.push_back(found - free.begin());
    }
  }
  return places;
}

Eigen::MatrixXd with_ridge(Eigen::MatrixXd hessian) {
  const double largest = hessian.diagonal().maxCoeff();
  hessian.diagonal() += kParameterRidge * hessian.diagonal().cwiseMax(
                                              largest * std::numeric_limits<double>::epsilon());
  return hessian;
}

// W of MinimumDistance, axes · terms × axes · terms.
Eigen::MatrixXd distance_metric(const FreeFit& fit, const Eigen::MatrixXd& mass) {
  const Eigen::MatrixXd inverse = equilibrated_inverse(mass * fit.noise * mass.transpose());
  const Eigen::Index terms = fit.gram.rows();
  const Eigen::Index axes = mass.rows();
  Eigen::MatrixXd metric(axes * terms, axes * terms);
  for (Eigen::Index a = 0; a < terms; ++a) {
    for (Eigen::Index b = 0; b < terms; ++b) {
      metric.block(axes * a, axes * b, axes, axes) = fit.gram(a, b) * inverse;
    }
  }
  return metric;
}

}  // namespace

double misfit_of(const MinimumDistance& best, const SandwichErrors& errors) {
  return std::max(
      1.0, best.distance / std::max(errors.expected_distance, std::numeric_limits<double>::min()));
}

FreeFit without_thrusters(const FreeFit& fit) {
  const Eigen::Index thrust = fit.gram.rows() - kTermThrusters;
  FreeFit vehicle{.coefficients = fit.coefficients.topRows(kTermThrusters),
                  .gram = fit.gram.topLeftCorner(kTermThrusters, kTermThrusters),
                  .noise = fit.noise,
                  .scores = {}};
  const Eigen::MatrixXd across = fit.gram.topRightCorner(kTermThrusters, thrust);
  vehicle.gram -= across * equilibrated_inverse(fit.gram.bottomRightCorner(thrust, thrust)) *
                  across.transpose();
  return vehicle;
}

MinimumDistance minimise_distance(const FreeFit& fit, const EquationStructure& structure,
                                  MinimumDistance start) {
  MinimumDistance best = std::move(start);
  ConeProgram program{.signs = places_in(best.free, structure.positive), .least = structure.least};
  if (structure.block) {
    const std::vector<Eigen::Index> block = places_in(best.free, *structure.block);
    program.block = {block[0], block[1], block[2]};
  }
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::MatrixXd metric = distance_metric(fit, structure.mass(best.parameters));
    const StructureResidual residual = structure.residual(fit.coefficients, best.parameters);
    const Eigen::MatrixXd jacobian = residual.jacobian(Eigen::all, best.free);
    const Eigen::MatrixXd weighted = metric * jacobian;
    best.hessian = with_ridge(jacobian.transpose() * weighted);
    const Eigen::VectorXd now = chosen(best.parameters, best.free);
    program.hessian = best.hessian;
    program.gradient = best.hessian * now - weighted.transpose() * residual.value;
    const ConeSolution next = solve(program);
    best.parameters(best.free) = next.x;
    best.at_bound.assign(static_cast<std::size_t>(best.parameters.size()), false);
    for (std::size_t i = 0; i < best.free.size(); ++i) {
      best.at_bound[static_cast<std::size_t>(best.free[i])] = next.at_bound[i];
    }
    best.indefinite = next.block_at_bound;
    best.distance = residual.value.dot(metric * residual.value);
    const Eigen::VectorXd scale = best.hessian.diagonal().cwiseSqrt();
    if (scale.cwiseProduct(next.x - now).norm() <= kConverged * scale.cwiseProduct(next.x).norm()) {
      break;
    }
  }
  return best;
}

Eigen::MatrixXd distance_hessian(const FreeFit& fit, const EquationStructure& structure,
                                 const MinimumDistance& best) {
  const Eigen::MatrixXd jacobian =
      structure.residual(fit.coefficients, best.parameters).jacobian(Eigen::all, best.free);
  return with_ridge(jacobian.transpose() *
                    (distance_metric(fit, structure.mass(best.parameters)) * jacobian));
}

Eigen::MatrixXd gradient_covariance(const FreeFit& fit, const EquationStructure& structure,
                                    const MinimumDistance& best) {
  const Eigen::MatrixXd mass = structure.mass(best.parameters);
  const Eigen::MatrixXd jacobian =
      structure.residual(fit.coefficients, best.parameters).jacobian(Eigen::all, best.free);
  const Eigen::MatrixXd weight = equilibrated_inverse(mass * fit.noise * mass.transpose()) * mass;
  Eigen::MatrixXd by_scores(jacobian.cols(), jacobian.rows());
  for (Eigen::Index term = 0; term < fit.gram.rows(); ++term) {
    by_scores.middleCols(mass.rows() * term, mass.rows()) =
        jacobian.middleRows(mass.rows() * term, mass.rows()).transpose() * weight;
  }
  return by_scores * fit.scores * by_scores.transpose();
}

SandwichErrors sandwich(const FreeFit& fit, const EquationStructure& structure,
                        const MinimumDistance& best) {
  const Eigen::MatrixXd mass = structure.mass(best.parameters);
  const Eigen::MatrixXd metric = distance_metric(fit, mass);
  const Eigen::MatrixXd jacobian =
      structure.residual(fit.coefficients, best.parameters).jacobian(Eigen::all, best.free);
  const Eigen::Index terms = fit.gram.rows();
  const Eigen::Index axes = mass.rows();
  Eigen::MatrixXd inverse = equilibrated_inverse(fit.gram);
  for (Eigen::Index term = 0; term < terms; ++term) {
    inverse(term, term) *= fit.gram(term, term) > 0.0 ? 1.0 : 0.0;  // what never was has no score
  }
  Eigen::MatrixXd from_scores(axes * terms, axes * terms);  // scores to M ΔBᵀ
  for (Eigen::Index a = 0; a < terms; ++a) {
    for (Eigen::Index b = 0; b < terms; ++b) {
      from_scores.block(axes * a, axes * b, axes, axes) = inverse(a, b) * mass;
    }
  }
  const Eigen::MatrixXd noise = from_scores * fit.scores * from_scores.transpose();
  const Eigen::MatrixXd weighted = metric * jacobian;
  const Eigen::MatrixXd gain = best.hessian.ldlt().solve(weighted.transpose());
  const Eigen::MatrixXd left =
      Eigen::MatrixXd::Identity(axes * terms, axes * terms) - jacobian * gain;
  return {gain * noise * gain.transpose(), (metric * left * noise * left.transpose()).trace()};
}

}  // namespace kelpie
