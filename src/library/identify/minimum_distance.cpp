// SPDX-License-Identifier: Apache-2.0
#include "identify/minimum_distance.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include "core/decomposition.hpp"
#include "core/normal_equations.hpp"
#include "identify/cone_program.hpp"
#include "identify/tuning.hpp"

namespace kelpie {
namespace {

constexpr int kMostSteps = 50;
constexpr int kFullSteps = 25;  // then half of each, which ends an alternation
constexpr int kMostHalvings = 8;
constexpr double kMostGrowth = 3.0;  // of the distance over the least so far
constexpr double kSmall = 1e-6;      // of the distance of no forces: less may grow
constexpr double kConverged = 1e-9;
constexpr double kNearlyConverged = 1e-6;  // after the last step
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

ConeProgram bounds_of(const EquationStructure& structure, const std::vector<Eigen::Index>& free) {
  ConeProgram program{.signs = places_in(free, structure.positive), .least = structure.least};
  if (structure.block) {
    const std::vector<Eigen::Index> block = places_in(free, *structure.block);
    program.block = {block[0], block[1], block[2]};
  }
  return program;
}

void set_bounds(const ConeSolution& solution, MinimumDistance& best) {
  best.at_bound.assign(static_cast<std::size_t>(best.parameters.size()), false);
  for (std::size_t i = 0; i < best.free.size(); ++i) {
    best.at_bound[static_cast<std::size_t>(best.free[i])] = solution.at_bound[i];
  }
  best.indefinite = solution.block_at_bound;
}

// R'WR, and half its gradient and curvature by the free parameters with W held.
struct LocalDistance {
  double value = 0.0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};

LocalDistance distance_at(const FreeFit& fit, const EquationStructure& structure,
                          const MinimumDistance& best) {
  const Eigen::MatrixXd metric = distance_metric(fit, structure.mass(best.parameters));
  const StructureResidual residual = structure.residual(fit.coefficients, best.parameters);
  const Eigen::MatrixXd jacobian = residual.jacobian(Eigen::all, best.free);
  const Eigen::MatrixXd weighted = metric * jacobian;
  return {residual.value.dot(metric * residual.value), weighted.transpose() * residual.value,
          with_ridge(jacobian.transpose() * weighted)};
}

// R'WR of Θ = 0, whatever M.
double distance_of_none(const FreeFit& fit) {
  const Eigen::MatrixXd squares = fit.coefficients.transpose() * fit.gram * fit.coefficients;
  return std::max((squares * equilibrated_inverse(fit.noise)).trace(),
                  std::numeric_limits<double>::min());
}

}  // namespace

double misfit_of(const MinimumDistance& best, const SandwichErrors& errors) {
  return std::max(
      1.0, best.distance / std::max(errors.expected_distance, std::numeric_limits<double>::min()));
}

double unexplained_share(const FreeFit& fit, const MinimumDistance& best) {
  return best.distance / distance_of_none(fit);
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

// With W held, a step is a convex program (three-stage least squares). But W follows M, and M, Θ →
// 0 with all thrust unexplained is a fixed point, too. R'WR with the W of each M tells: it is the
// distance of the free coefficients from M⁻¹Θ, which no factor of M and Θ lowers. So a step is
// halved until the distance is near the least so far (backtracking: Nocedal & Wright 2006, ch. 3):
// near, for the fixed point wanted is not the minimum of the distance.
MinimumDistance minimise_distance(const FreeFit& fit, const EquationStructure& structure,
                                  MinimumDistance start) {
  MinimumDistance best = std::move(start);
  ConeProgram program = bounds_of(structure, best.free);
  LocalDistance at = distance_at(fit, structure, best);
  best.converged = false;
  best.distance = at.value;
  set_bounds({.x = {}, .at_bound = std::vector<bool>(best.free.size(), false)}, best);
  MinimumDistance nearest = best;
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::VectorXd now = chosen(best.parameters, best.free);
    best.hessian = at.hessian;
    best.distance = at.value;
    program.hessian = at.hessian;
    program.gradient = at.hessian * now - at.gradient;
    const ConeSolution next = solve(program);
    set_bounds(next, best);
    const Eigen::VectorXd scale = at.hessian.diagonal().cwiseSqrt();
    const double moved = scale.cwiseProduct(next.x - now).norm();
    const double size = scale.cwiseProduct(next.x).norm();
    best.converged = moved <= kNearlyConverged * size;
    if (moved <= kConverged * size) {
      best.parameters(best.free) = next.x;
      return best;
    }
    const double most = kMostGrowth * std::max(nearest.distance, kSmall * distance_of_none(fit));
    double share = step < kFullSteps ? 1.0 : 0.5;
    bool is_near = false;
    for (int halved = 0; halved <= kMostHalvings && !is_near; ++halved, share *= 0.5) {
      best.parameters(best.free) = now + share * (next.x - now);
      at = distance_at(fit, structure, best);
      is_near = at.value >= 0.0 && at.value <= most;
    }
    if (!is_near) {
      break;
    }
    if (at.value < nearest.distance) {
      nearest = best;
      nearest.distance = at.value;
    }
  }
  if (best.converged) {
    return best;
  }
  nearest.converged = false;
  nearest.hessian = distance_at(fit, structure, nearest).hessian;
  return nearest;
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
  const Eigen::MatrixXd gain = solve_symmetric(best.hessian, Eigen::MatrixXd(weighted.transpose()));
  const Eigen::MatrixXd left =
      Eigen::MatrixXd::Identity(axes * terms, axes * terms) - jacobian * gain;
  return {gain * noise * gain.transpose(), (metric * left * noise * left.transpose()).trace()};
}

}  // namespace kelpie
