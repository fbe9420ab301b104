// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "vehicle/scenario.hpp"

namespace kelpie::lab {

/// The plan of a study: a scenario of one configuration and a number of seeds.
struct IdentifyPlan {
  vehicle::Scenario scenario;
  std::size_t seeds = 20;
  /// Called with the finished share; false stops.
  std::function<bool(double)> keep_going = [](double) { return true; };
};

/// A parameter over the seeds, against the true value of the simulated vehicle.
struct IdentifiedParameter {
  std::string name;
  double truth = 0.0;
  double mean = 0.0;
  double root_mean_square_error = 0.0;
  double worst_error = 0.0;
  double mean_standard_error = 0.0;
  double coverage = 0.0;  ///< share of seeds with the truth inside the 90 % interval
};

struct IdentifyStudy {
  std::size_t seeds = 0;
  std::vector<IdentifiedParameter> parameters;
  double coverage = 0.0;           ///< over parameters and seeds
  std::vector<double> per_seed{};  ///< share of the parameters inside their intervals
  double mean_misfit = 0.0;
};

/// Simulates and identifies all rows; the scale from the left thruster's true forward coefficient.
/// Throws InputError as the simulator and fit_planar() do.
IdentifyStudy study_identification(const IdentifyPlan& plan);

}  // namespace kelpie::lab
