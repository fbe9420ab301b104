// SPDX-License-Identifier: Apache-2.0
#include "motion/minimum_distance.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/normal_equations.hpp"
#include "kelpie/motion/planar_fit.hpp"
#include "motion/cone_program.hpp"
#include "motion/structure.hpp"
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

// Drags and thrusts among the free parameters, as places in `free`.
std::vector<Eigen::Index> signed_places(const std::vector<Eigen::Index>& free) {
  std::vector<Eigen::Index> places;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const auto place = static_cast<std::size_t>(free[i]);
    const bool is_drag = place >= PlanarPlace::linear_drag && place < PlanarPlace::constant_force;
    const bool is_thrust = place >= PlanarPlace::thrusters &&
                           (place - PlanarPlace::thrusters) % PlanarPlace::per_thruster < 2;
    if (is_drag || is_thrust) {
      places.push_back(static_cast<Eigen::Index>(i));
    }
  }
  return places;
}

Eigen::Index place_in(const std::vector<Eigen::Index>& free, std::size_t parameter) {
  return std::ranges::find(free, static_cast<Eigen::Index>(parameter)) - free.begin();
}

Eigen::MatrixXd with_ridge(Eigen::MatrixXd hessian) {
  const double largest = hessian.diagonal().maxCoeff();
  hessian.diagonal() += kParameterRidge * hessian.diagonal().cwiseMax(
                                              largest * std::numeric_limits<double>::epsilon());
  return hessian;
}

}  // namespace

Eigen::MatrixXd distance_metric(const FreeFit& fit, const Eigen::Matrix3d& mass) {
  const Eigen::Matrix3d inverse = (mass * fit.noise * mass.transpose()).inverse();
  const Eigen::Index terms = fit.gram.rows();
  Eigen::MatrixXd metric(3 * terms, 3 * terms);
  for (Eigen::Index a = 0; a < terms; ++a) {
    for (Eigen::Index b = 0; b < terms; ++b) {
      metric.block<3, 3>(3 * a, 3 * b) = fit.gram(a, b) * inverse;
    }
  }
  return metric;
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

MinimumDistance minimise_distance(const FreeFit& fit, MinimumDistance start) {
  MinimumDistance best = std::move(start);
  const double least = kIdentification.least_inertia *
                       best.parameters(static_cast<Eigen::Index>(PlanarPlace::yaw_inertia));
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::MatrixXd metric = distance_metric(fit, planar_mass(best.parameters));
    const StructureResidual residual = structure_residual(fit.coefficients, best.parameters);
    const Eigen::MatrixXd jacobian = residual.jacobian(Eigen::all, best.free);
    const Eigen::MatrixXd weighted = metric * jacobian;
    best.hessian = with_ridge(jacobian.transpose() * weighted);
    const Eigen::VectorXd now = chosen(best.parameters, best.free);
    const ConeSolution next =
        solve({.hessian = best.hessian,
               .gradient = best.hessian * now - weighted.transpose() * residual.value,
               .signs = signed_places(best.free),
               .block = {place_in(best.free, PlanarPlace::sway_inertia),
                         place_in(best.free, PlanarPlace::sway_yaw_inertia),
                         place_in(best.free, PlanarPlace::yaw_inertia)},
               .least = least});
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

}  // namespace kelpie
