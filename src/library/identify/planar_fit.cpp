// SPDX-License-Identifier: Apache-2.0
#include "kelpie/identify/planar_fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/decomposition.hpp"
#include "core/eigen.hpp"
#include "core/normal_equations.hpp"
#include "core/text.hpp"
#include "identify/expected_fit.hpp"
#include "identify/minimum_distance.hpp"
#include "identify/planar_estimate.hpp"
#include "identify/structure.hpp"
#include "identify/tuning.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie {
namespace {

// In the plane, with as many parameters as `parameters`.
EquationStructure planar_structure(const Eigen::VectorXd& parameters) {
  EquationStructure structure{.residual = structure_residual, .mass = planar_mass};
  for (Eigen::Index place = 0; place < parameters.size(); ++place) {
    const auto at = static_cast<std::size_t>(place);
    const bool is_drag = at >= PlanarPlace::linear_drag && at < PlanarPlace::constant_force;
    const bool is_thrust = at >= PlanarPlace::thrusters &&
                           (at - PlanarPlace::thrusters) % PlanarPlace::per_thruster < 2;
    if (is_drag || is_thrust) {
      structure.positive.push_back(place);
    }
  }
  structure.block = {static_cast<Eigen::Index>(PlanarPlace::sway_inertia),
                     static_cast<Eigen::Index>(PlanarPlace::sway_yaw_inertia),
                     static_cast<Eigen::Index>(PlanarPlace::yaw_inertia)};
  structure.least = kIdentification.least_inertia *
                    parameters(static_cast<Eigen::Index>(PlanarPlace::yaw_inertia));
  return structure;
}

MinimumDistance fit_structure(const FreeFit& fit, std::size_t thrusters) {
  MinimumDistance start{.parameters = first_guess(fit, thrusters)};
  const auto vehicle_size = static_cast<Eigen::Index>(PlanarPlace::thrusters);
  MinimumDistance vehicle{.parameters = start.parameters.head(vehicle_size)};
  vehicle.free = sought_places(fit.gram, vehicle_size);
  const EquationStructure without = planar_structure(vehicle.parameters);
  vehicle = minimise_distance(without_thrusters(fit), without, std::move(vehicle));
  start.parameters.head(vehicle_size) = vehicle.parameters;
  guess_thrusters(fit, start.parameters);
  start.free = sought_places(fit.gram, start.parameters.size());
  const EquationStructure structure = planar_structure(start.parameters);
  return minimise_distance(fit, structure, std::move(start));
}

// The size of what a parameter does to its axis, per unit of it, and of all that is done there.
double blur(std::size_t place, double error, const Eigen::VectorXd& parameters,
            const WeakRows& rows, const Eigen::Vector3d& forces) {
  const auto rms = [&](const Eigen::VectorXd& values) {
    return std::sqrt(values.squaredNorm() /
                     static_cast<double>(std::max<Eigen::Index>(1, values.size())));
  };
  const auto term = [&](Eigen::Index index) { return rms(rows.terms.col(index)); };
  const auto relative = [&](double effect, Eigen::Index axis) {
    return error * effect / forces(axis);
  };
  if (place >= PlanarPlace::thrusters) {
    const std::size_t index = (place - PlanarPlace::thrusters) / PlanarPlace::per_thruster;
    const auto at = static_cast<Eigen::Index>(PlanarPlace::thruster(index));
    const Eigen::Index first = kTermThrusters + 2 * static_cast<Eigen::Index>(index);
    const double angle = parameters(at + 2);
    const double thrust = parameters(at) * term(first) + parameters(at + 1) * term(first + 1);
    const Eigen::Vector3d axis(std::cos(angle), std::sin(angle), parameters(at + 3));
    const auto which = static_cast<Eigen::Index>(place) - at;
    const Eigen::Vector3d share = axis.cwiseAbs().cwiseQuotient(forces);
    if (which < 2) {
      return error * term(first + which) * share.maxCoeff();
    }
    return which == 2 ? error * thrust / std::min(forces(0), forces(1)) : relative(thrust, 2);
  }
  switch (place) {
    case PlanarPlace::sway_inertia:
      return relative(rms(rows.acceleration.col(1)) + term(kTermUv), 1);
    case PlanarPlace::sway_yaw_inertia:
      return relative(rms(rows.acceleration.col(1)) + term(kTermUr), 2);
    case PlanarPlace::yaw_inertia:
      return relative(rms(rows.acceleration.col(2)), 2);
    case PlanarPlace::surge_inertia:
      return 0.0;
    default:
      break;
  }
  const std::size_t axis = (place - PlanarPlace::linear_drag) % kPlanarAxes;
  const Eigen::Index first = place < PlanarPlace::quadratic_drag   ? kTermLinear
                             : place < PlanarPlace::constant_force ? kTermQuadratic
                                                                   : kTermOne;
  const auto along = static_cast<Eigen::Index>(axis);
  return relative(term(first == kTermOne ? kTermOne : first + along), along);
}

// What is accelerated, dragged or pushed on each axis.
Eigen::Vector3d force_sizes(const WeakRows& rows, const Eigen::VectorXd& parameters) {
  const Eigen::MatrixXd inertial = rows.acceleration * planar_mass(parameters).transpose();
  return (inertial.colwise().norm() /
          std::sqrt(static_cast<double>(std::max<Eigen::Index>(1, inertial.rows()))))
      .transpose()
      .cwiseMax(std::numeric_limits<double>::min());
}

// What was never seen: a thruster counts as alike both ways.
void complete(const Eigen::MatrixXd& gram, Eigen::VectorXd& parameters) {
  for (Eigen::Index term = kTermThrusters; term < gram.rows(); term += 2) {
    const auto index = static_cast<std::size_t>((term - kTermThrusters) / 2);
    const auto at = static_cast<Eigen::Index>(PlanarPlace::thruster(index));
    for (const Eigen::Index way : {0, 1}) {
      if (gram(term + way, term + way) <= 0.0) {
        parameters(at + way) = parameters(at + 1 - way);
      }
    }
  }
}

// Bᵀ = M⁻¹ Θ(θ).
Eigen::MatrixXd structure_coefficients(const Eigen::VectorXd& parameters, Eigen::Index terms) {
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(terms, 3);
  const Eigen::VectorXd value = structure_residual(none, parameters).value;
  const Eigen::MatrixXd theta = -Eigen::Map<const Eigen::MatrixXd>(value.data(), 3, terms);
  return (planar_mass(parameters).inverse() * theta).transpose();
}

void require_windows(const WeakRows& weak) {
  const auto least = static_cast<Eigen::Index>(kIdentification.windows_per_term *
                                               static_cast<double>(weak.terms.cols()));
  if (weak.terms.rows() < least) {
    throw InputError("too few rows: " + std::to_string(weak.terms.rows()) +
                     " windows of 5 s without a gap, " + std::to_string(least) + " are needed");
  }
}

// The windows in which the terms explain most, by the determinant of the residuals' covariance.
WeakRows explained_windows(const PlanarRows& rows) {
  WeakRows best;
  double least = std::numeric_limits<double>::infinity();
  for (const BetweenRows between :
       {BetweenRows::ramps, BetweenRows::steps_after, BetweenRows::steps_before}) {
    WeakRows windows = weak_rows(rows, {}, between);
    require_windows(windows);
    const double noise = determinant(free_noise(windows));
    if (between == BetweenRows::ramps || noise < least) {
      least = noise;
      best = std::move(windows);
    }
  }
  return best;
}

}  // namespace

std::vector<Eigen::Index> sought_places(const Eigen::MatrixXd& gram, Eigen::Index parameters) {
  std::vector<Eigen::Index> places;
  for (Eigen::Index place = 1; place < parameters; ++place) {
    const Eigen::Index of_thruster = place - static_cast<Eigen::Index>(PlanarPlace::thrusters);
    const Eigen::Index term = kTermThrusters + 2 * (of_thruster / 4) + of_thruster % 4;
    if (of_thruster >= 0 && of_thruster % 4 < 2 && gram(term, term) <= 0.0) {
      continue;
    }
    places.push_back(place);
  }
  return places;
}

PlanarFit planar_estimate(const std::vector<std::string>& thrusters, const WeakRows& weak,
                          const MinimumDistance& best, const Eigen::MatrixXd& errors,
                          double misfit) {
  PlanarFit fit;
  fit.windows = static_cast<std::size_t>(weak.terms.rows());
  fit.window_s = 2.0 * kIdentification.half_window_s;
  fit.misfit = misfit;
  fit.parameters = planar_parameters(thrusters);
  fit.covariance = Matrix(fit.parameters.size(), fit.parameters.size());
  auto covariance = as_matrix(fit.covariance);
  covariance(best.free, best.free) = misfit * errors;
  const Eigen::Vector3d forces = force_sizes(weak, best.parameters);
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    FittedParameter& parameter = fit.parameters[i];
    const auto place = static_cast<Eigen::Index>(i);
    const bool is_sought = std::ranges::find(best.free, place) != best.free.end();
    parameter.value = best.parameters(place);
    const double chance = std::sqrt(covariance(place, place) / misfit);  // excitation's alone
    if (is_sought) {
      const double allowance = parameter.kind == ParameterKind::angle
                                   ? kIdentification.angle_allowance_rad
                                   : kIdentification.plane_allowance * parameter.value;
      covariance(place, place) += allowance * allowance;
    }
    parameter.error = std::sqrt(covariance(place, place));
    parameter.state =
        i == PlanarPlace::surge_inertia ? ParameterState::known
        : !is_sought || blur(i, chance, best.parameters, weak, forces) > kIdentification.most_blur
            ? ParameterState::not_told
        : best.at_bound[i] ? ParameterState::at_bound
                           : ParameterState::identified;
  }
  return fit;
}

void require_excitation(const PlanarFit& fit, const MinimumDistance& best) {
  std::vector<std::string> missing;
  for (const std::size_t place : {PlanarPlace::sway_inertia, PlanarPlace::yaw_inertia}) {
    if (fit.parameters[place].state == ParameterState::not_told || best.indefinite) {
      missing.push_back(fit.parameters[place].name);
    }
  }
  for (std::size_t at = PlanarPlace::thrusters; at < fit.parameters.size();
       at += PlanarPlace::per_thruster) {
    if (fit.parameters[at].state == ParameterState::not_told &&
        fit.parameters[at + 1].state == ParameterState::not_told) {
      missing.push_back(fit.parameters[at].name);
    }
  }
  if (!missing.empty()) {
    throw InputError("too little excitation to tell " + join_text(missing, ", ") +
                     "; it takes a log in which surge, sway and yaw speed up and slow down, and "
                     "every thruster runs by itself");
  }
}

std::vector<FittedParameter> unknown_parameters(
    const std::vector<std::pair<std::string, ParameterKind>>& named) {
  std::vector<FittedParameter> parameters;
  for (const auto& [name, kind] : named) {
    parameters.push_back({.name = name, .scales = kind < ParameterKind::arm, .kind = kind});
  }
  return parameters;
}

std::vector<FittedParameter> planar_parameters(const std::vector<std::string>& thrusters) {
  using enum ParameterKind;
  std::vector<std::pair<std::string, ParameterKind>> named{
      {"surge_inertia", inertia},   {"sway_inertia", inertia},      {"sway_yaw_inertia", coupling},
      {"yaw_inertia", inertia},     {"surge_linear_drag", size},    {"sway_linear_drag", size},
      {"yaw_linear_drag", size},    {"surge_quadratic_drag", size}, {"sway_quadratic_drag", size},
      {"yaw_quadratic_drag", size}, {"surge_force", offset},        {"sway_force", offset},
      {"yaw_moment", offset}};
  for (const std::string& thruster : thrusters) {
    named.insert(named.end(), {{thruster + ".forward", size},
                               {thruster + ".reverse", size},
                               {thruster + ".angle", angle},
                               {thruster + ".arm", arm}});
  }
  return unknown_parameters(named);
}

std::vector<std::string> planar_parameter_names(const std::vector<std::string>& thrusters) {
  std::vector<std::string> names;
  for (const FittedParameter& parameter : planar_parameters(thrusters)) {
    names.push_back(parameter.name);
  }
  return names;
}

PlanarFit fit_planar(const PlanarRows& rows) {
  const WeakRows weak = explained_windows(rows);
  const FreeFit free_fit = fit_freely(weak);
  const MinimumDistance best = fit_structure(free_fit, rows.thrusters.size());
  const SandwichErrors errors = sandwich(free_fit, planar_structure(best.parameters), best);
  PlanarFit fit =
      planar_estimate(rows.thrusters, weak, best, errors.covariance, misfit_of(best, errors));
  fit.free_terms = Matrix(static_cast<std::size_t>(free_fit.coefficients.rows()), kPlanarAxes);
  as_matrix(fit.free_terms) = free_fit.coefficients;
  require_excitation(fit, best);
  return fit;
}

ExpectedPlanarFit::ExpectedPlanarFit(const PlanarRows& rows)
    : thrusters_(rows.thrusters), weak_(explained_windows(rows)) {
  free_ = fit_freely(weak_);
  best_ = fit_structure(free_, thrusters_.size());
  const SandwichErrors errors = sandwich(free_, planar_structure(best_.parameters), best_);
  misfit_ = misfit_of(best_, errors);
  noise_ = window_noise(weak_, free_, kPlanarWindow);
  const std::vector<Eigen::Index> told = best_.free;
  complete(free_.gram, best_.parameters);
  best_.at_bound.assign(static_cast<std::size_t>(best_.parameters.size()), false);
  free_.coefficients = structure_coefficients(best_.parameters, free_.gram.rows());
  free_.scores = expected_scores(weak_.terms, noise_);
  factor_ =
      std::max(1.0, median_ratio(errors.covariance, covariance_of(free_.gram, free_.scores, told)));
  free_.scores *= factor_;
  now_ = fit_of(free_.gram, free_.scores, weak_);
}

ParameterFit ExpectedPlanarFit::after(const WeakRows& drives) const {
  if (drives.terms.rows() == 0) {
    return now_;
  }
  WeakRows all;
  all.terms.resize(weak_.terms.rows() + drives.terms.rows(), weak_.terms.cols());
  all.terms << weak_.terms, drives.terms;
  all.acceleration.resize(all.terms.rows(), weak_.acceleration.cols());
  all.acceleration << weak_.acceleration, drives.acceleration;
  return fit_of(free_.gram + drives.terms.transpose() * drives.terms,
                free_.scores + factor_ * expected_scores(drives.terms, noise_), all);
}

Eigen::MatrixXd ExpectedPlanarFit::covariance_of(const Eigen::MatrixXd& gram,
                                                 const Eigen::MatrixXd& scores,
                                                 const std::vector<Eigen::Index>& free) const {
  const FreeFit expected{
      .coefficients = free_.coefficients, .gram = gram, .noise = free_.noise, .scores = scores};
  const EquationStructure structure = planar_structure(best_.parameters);
  MinimumDistance best{.parameters = best_.parameters, .free = free};
  best.hessian = distance_hessian(expected, structure, best);
  return sandwich(expected, structure, best).covariance;
}

ExpectedFit::Information ExpectedPlanarFit::information(const WeakRows& drives) const {
  const FreeFit changed{.coefficients = free_.coefficients,
                        .gram = drives.terms.transpose() * drives.terms,
                        .noise = free_.noise,
                        .scores = factor_ * expected_scores(drives.terms, noise_)};
  const EquationStructure structure = planar_structure(best_.parameters);
  MinimumDistance best{.parameters = best_.parameters};
  for (Eigen::Index place = 0; place < best.parameters.size(); ++place) {
    best.free.push_back(place);
  }
  return {distance_hessian(changed, structure, best),
          gradient_covariance(changed, structure, best)};
}

PlanarFit ExpectedPlanarFit::fit_of(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& scores,
                                    const WeakRows& windows) const {
  MinimumDistance best = best_;
  best.free = sought_places(gram, best.parameters.size());
  return planar_estimate(thrusters_, windows, best, covariance_of(gram, scores, best.free),
                         misfit_);
}

std::array<AccelerationCheck, kPlanarAxes> check_accelerations(
    const PlanarRows& rows, std::span<const double> accelerations) {
  const WeakRows weak = weak_rows(rows, accelerations);
  require_windows(weak);
  std::array<AccelerationCheck, kPlanarAxes> checks{};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Eigen::ArrayXd own =
        weak.acceleration.col(axis).array() - weak.acceleration.col(axis).mean();
    const Eigen::ArrayXd given = weak.given.col(axis).array() - weak.given.col(axis).mean();
    const double both = (own * given).sum();
    const double least = std::numeric_limits<double>::min();
    checks[static_cast<std::size_t>(axis)] = {
        both / std::max(std::sqrt(own.square().sum() * given.square().sum()), least),
        both / std::max(own.square().sum(), least)};
  }
  return checks;
}

}  // namespace kelpie
