// SPDX-License-Identifier: Apache-2.0
#include "lab/identify_study.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kelpie/motion/planar_fit.hpp"
#include "vehicle/dynamics.hpp"
#include "vehicle/simulation.hpp"
#include "vehicle/parameters.hpp"

namespace kelpie::lab {
namespace {

constexpr double kNormal90 = 1.645;
constexpr double kRounding = 1e-9;
constexpr std::array<Eigen::Index, kPlanarAxes> kOfSix{0, 1, 5};

// In FLU, as the log is.
std::vector<double> truth_of(const vehicle::Scenario& scenario) {
  const vehicle::Plant plant =
      vehicle::make_plant(scenario.vehicle, scenario.configurations.front());
  std::vector<double> truth{plant.mass(0, 0), plant.mass(1, 1), plant.mass(1, 5), plant.mass(5, 5)};
  for (const Eigen::Index axis : kOfSix) {
    truth.push_back(plant.linear_damping(axis));
  }
  for (const Eigen::Index axis : kOfSix) {
    truth.push_back(plant.quadratic_damping(axis));
  }
  truth.insert(truth.end(), kPlanarAxes, 0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const vehicle::Vector6 axis = plant.thrust_axes.col(static_cast<Eigen::Index>(i));
    truth.push_back(plant.thrusters[i].forward);
    truth.push_back(plant.thrusters[i].reverse);
    truth.push_back(std::atan2(-axis(1), axis(0)));
    truth.push_back(-axis(5));
  }
  return truth;
}

PlanarFit identify_seed(const vehicle::Scenario& scenario) {
  PlanarRows rows;
  rows.thrusters = {"th1", "th2", "th3"};
  for (const vehicle::LogRow& row : vehicle::simulate(scenario)) {
    rows.times_s.push_back(row.t_s);
    rows.velocities.insert(rows.velocities.end(), row.velocity.begin(), row.velocity.end());
    rows.speeds.insert(rows.speeds.end(), row.rotors_rps.begin(), row.rotors_rps.end());
  }
  return scaled_by_thrust(fit_planar(rows),
                          {{"th1", scenario.vehicle.thrusters[vehicle::kSurgeLeft].forward}});
}

}  // namespace

IdentifyStudy study_identification(const IdentifyPlan& plan) {
  const std::vector<double> truth = truth_of(plan.scenario);
  IdentifyStudy study;
  std::size_t inside_all = 0;
  std::size_t judged_all = 0;
  for (std::size_t i = 0; i < plan.seeds; ++i) {
    vehicle::Scenario scenario = plan.scenario;
    scenario.seed = plan.scenario.seed + i;
    const PlanarFit fit = identify_seed(scenario);
    study.parameters.resize(fit.parameters.size());
    std::size_t inside = 0;
    std::size_t judged = 0;
    for (std::size_t p = 0; p < fit.parameters.size(); ++p) {
      const PlanarParameter& found = fit.parameters[p];
      const double off = std::abs(found.value - truth[p]);
      const bool held = off <= kNormal90 * found.error + kRounding * std::abs(truth[p]);
      IdentifiedParameter& row = study.parameters[p];
      row.name = found.name;
      row.truth = truth[p];
      row.mean += found.value;
      row.root_mean_square_error += off * off;
      row.worst_error = std::max(row.worst_error, off);
      row.mean_standard_error += found.error;
      row.coverage += held ? 1.0 : 0.0;
      if (found.state == ParameterState::identified) {
        inside += held ? 1 : 0;
        ++judged;
      }
    }
    inside_all += inside;
    judged_all += judged;
    study.per_seed.push_back(static_cast<double>(inside) / static_cast<double>(judged));
    study.mean_misfit += fit.misfit;
    ++study.seeds;
    if (!plan.keep_going(static_cast<double>(i + 1) / static_cast<double>(plan.seeds))) {
      break;
    }
  }
  const auto seeds = static_cast<double>(study.seeds);
  for (IdentifiedParameter& row : study.parameters) {
    row.mean /= seeds;
    row.root_mean_square_error = std::sqrt(row.root_mean_square_error / seeds);
    row.mean_standard_error /= seeds;
    row.coverage /= seeds;
  }
  study.coverage = static_cast<double>(inside_all) / static_cast<double>(judged_all);
  study.mean_misfit /= seeds;
  return study;
}

}  // namespace kelpie::lab
