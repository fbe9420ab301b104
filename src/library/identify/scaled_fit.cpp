// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/eigen.hpp"
#include "core/text.hpp"
#include "identify/weak_form.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/identify/planar_fit.hpp"

namespace kelpie {
namespace {

constexpr std::string_view kForward = ".forward";

std::size_t find_forward(const ParameterFit& fit, const std::string& thruster) {
  std::vector<std::string> names;
  for (std::size_t at = 0; at < fit.parameters.size(); ++at) {
    const std::string& name = fit.parameters[at].name;
    if (name.ends_with(kForward)) {
      names.push_back(name.substr(0, name.size() - kForward.size()));
      if (names.back() == thruster) {
        return at;
      }
    }
  }
  throw InputError("--thrust", unknown_name(thruster, "thruster", names));
}

// θ → s(θ) θ: `slope` holds d ln s / dθ, `extra` the relative variance of s that has other causes.
void apply_scale(ParameterFit& fit, double factor, const Eigen::VectorXd& slope, double extra) {
  const auto n = static_cast<Eigen::Index>(fit.parameters.size());
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(n);  // the values, where they have a scale
  for (Eigen::Index i = 0; i < n; ++i) {
    FittedParameter& parameter = fit.parameters[static_cast<std::size_t>(i)];
    if (parameter.scales) {
      parameter.value *= factor;
      moved(i) = parameter.value;
      jacobian.row(i) *= factor;
    }
  }
  jacobian += moved * slope.transpose();
  const Eigen::MatrixXd covariance = jacobian * as_matrix(fit.covariance) * jacobian.transpose() +
                                     extra * moved * moved.transpose();
  as_matrix(fit.covariance) = covariance;
  for (Eigen::Index i = 0; i < n; ++i) {
    fit.parameters[static_cast<std::size_t>(i)].error = std::sqrt(std::max(0.0, covariance(i, i)));
  }
}

}  // namespace

PlanarVehicle PlanarFit::vehicle() const {
  const auto value = [&](std::size_t place) { return parameters[place].value; };
  PlanarVehicle vehicle{.surge_inertia = value(PlanarPlace::surge_inertia),
                        .sway_inertia = value(PlanarPlace::sway_inertia),
                        .sway_yaw_inertia = value(PlanarPlace::sway_yaw_inertia),
                        .yaw_inertia = value(PlanarPlace::yaw_inertia)};
  for (std::size_t axis = 0; axis < kPlanarAxes; ++axis) {
    vehicle.linear_drag[axis] = value(PlanarPlace::linear_drag + axis);
    vehicle.quadratic_drag[axis] = value(PlanarPlace::quadratic_drag + axis);
    vehicle.constant_force[axis] = value(PlanarPlace::constant_force + axis);
  }
  for (std::size_t at = PlanarPlace::thrusters; at < parameters.size();
       at += PlanarPlace::per_thruster) {
    const std::string& name = parameters[at].name;
    vehicle.thrusters.push_back({.name = name.substr(0, name.rfind('.')),
                                 .forward = value(at),
                                 .reverse = value(at + 1),
                                 .angle_rad = value(at + 2),
                                 .arm_m = value(at + 3)});
  }
  return vehicle;
}

double ParameterFit::correlation(std::size_t a, std::size_t b) const {
  const double errors = std::sqrt(covariance(a, a) * covariance(b, b));
  return errors > 0.0 ? covariance(a, b) / errors : 0.0;
}

PlanarVector PlanarFit::free_acceleration(std::span<const double, kPlanarAxes> velocity,
                                          std::span<const double> speeds) const {
  Eigen::VectorXd terms(term_count(speeds.size()));
  PlanarTerms(speeds.size()).evaluate(velocity, speeds, terms);
  const Eigen::Vector3d acceleration = as_matrix(free_terms).transpose() * terms;
  return {acceleration(0), acceleration(1), acceleration(2)};
}

void scale_by_thrust(ParameterFit& fit,
                     const std::vector<std::pair<std::string, double>>& forward) {
  const auto n = static_cast<Eigen::Index>(fit.parameters.size());
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(n);
  const double share = 1.0 / static_cast<double>(forward.size());
  double log_factor = 0.0;
  std::vector<std::size_t> places;
  for (const auto& [thruster, given] : forward) {
    const std::size_t at = find_forward(fit, thruster);
    const FittedParameter& found = fit.parameters[at];
    require(given > 0.0, "--thrust", "has to be > 0, in N per square of the thruster's unit");
    if (found.state != ParameterState::identified) {
      throw InputError("--thrust",
                       "the log doesn't tell " + found.name + ", so that it can't give the scale");
    }
    log_factor += share * std::log(given / found.value);
    slope(static_cast<Eigen::Index>(at)) -= share / found.value;
    places.push_back(at);
  }
  apply_scale(fit, std::exp(log_factor), slope, 0.0);
  fit.parameters.front().state = ParameterState::identified;
  if (places.size() == 1) {
    fit.parameters[places.front()].state = ParameterState::known;
  }
}

void scale_by_inertia(ParameterFit& fit, double kilograms, double error) {
  apply_scale(fit, kilograms,
              Eigen::VectorXd::Zero(static_cast<Eigen::Index>(fit.parameters.size())),
              std::pow(error / kilograms, 2.0));
}

}  // namespace kelpie
