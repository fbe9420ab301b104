// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "vehicle/scenario.hpp"

namespace kelpie::lab {

/// What is identified, how often: a scenario of one configuration, driven from so many seeds.
struct IdentifyPlan {
  vehicle::Scenario scenario;
  std::size_t seeds = 20;
  /// Called with the share that is done; false stops.
  std::function<bool(double)> keep_going = [](double) { return true; };
};

/// How one parameter came out over all seeds, against the simulated vehicle's.
struct IdentifiedParameter {
  std::string name;
  double truth = 0.0;
  double mean = 0.0;
  double root_mean_square_error = 0.0;
  double worst_error = 0.0;
  double mean_standard_error = 0.0;
  double coverage = 0.0;  ///< share of the seeds whose 90 % interval holds the truth
};

struct IdentifyStudy {
  std::size_t seeds = 0;
  std::vector<IdentifiedParameter> parameters;
  double coverage = 0.0;           ///< of all parameters and seeds
  std::vector<double> per_seed{};  ///< share of the parameters inside their intervals
  double mean_misfit = 0.0;
};

/// Simulates and identifies all rows; the scale from the left thruster's true forward coefficient.
/// Throws InputError as the simulator and fit_planar() do.
IdentifyStudy study_identification(const IdentifyPlan& plan);

}  // namespace kelpie::lab
