// SPDX-License-Identifier: Apache-2.0
#include "lab/planar_truth.hpp"

#include <array>
#include <cmath>

#include "kelpie/identify/planar_fit.hpp"
#include "simulator/dynamics.hpp"

namespace kelpie::lab {
namespace {

constexpr std::array<Eigen::Index, kPlanarAxes> kOfSix{0, 1, 5};

}  // namespace

std::vector<double> planar_truth(const simulator::Scenario& scenario) {
  const simulator::Plant plant =
      simulator::make_plant(scenario.vehicle, scenario.configurations.front());
  std::vector<double> truth{plant.mass(0, 0), plant.mass(1, 1), plant.mass(1, 5), plant.mass(5, 5)};
  for (const Eigen::Index axis : kOfSix) {
    truth.push_back(plant.linear_damping(axis));
  }
  for (const Eigen::Index axis : kOfSix) {
    truth.push_back(plant.quadratic_damping(axis));
  }
  truth.insert(truth.end(), kPlanarAxes, 0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const simulator::Vector6 axis = plant.thrust_axes.col(static_cast<Eigen::Index>(i));
    truth.push_back(plant.forward(static_cast<Eigen::Index>(i)));
    truth.push_back(plant.reverse(static_cast<Eigen::Index>(i)));
    truth.push_back(std::atan2(-axis(1), axis(0)));
    truth.push_back(-axis(5));
  }
  return truth;
}

}  // namespace kelpie::lab
