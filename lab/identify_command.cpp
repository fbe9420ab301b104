// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "cli/output.hpp"
#include "core/quantile.hpp"
#include "kelpie/identify/planar_fit.hpp"
#include "lab/commands.hpp"
#include "lab/planar_truth.hpp"
#include "simulator/parameters.hpp"
#include "simulator/scenario_file.hpp"
#include "simulator/simulation.hpp"
#include "study/six_axes.hpp"

namespace kelpie::lab {
namespace {

constexpr double kRounding = 1e-9;

// As the log is: in the plane FLU, on six axes FRD.
std::vector<double> truth_of(const simulator::Scenario& scenario) {
  if (scenario.log == simulator::LogKind::six) {
    return study::six_axis_truth(scenario.vehicle);
  }
  return planar_truth(scenario);
}

// The scale is the true surge inertia.
ParameterFit identify_six_axes_seed(const simulator::Scenario& scenario) {
  return scaled_by_inertia(
      fit_six_axes(study::six_axis_rows(simulator::simulate_six_axes(scenario), scenario.vehicle)),
      study::six_axis_truth(scenario.vehicle).front(), 0.0);
}

// The scale is the left thruster's true forward coefficient.
ParameterFit identify_seed(const simulator::Scenario& scenario) {
  if (scenario.log == simulator::LogKind::six) {
    return identify_six_axes_seed(scenario);
  }
  PlanarRows rows;
  rows.thrusters = {"th1", "th2", "th3"};
  for (const simulator::LogRow& row : simulator::simulate(scenario)) {
    rows.times_s.push_back(row.t_s);
    rows.velocities.insert(rows.velocities.end(), row.velocity.begin(), row.velocity.end());
    rows.speeds.insert(rows.speeds.end(), row.rotors_rps.begin(), row.rotors_rps.end());
  }
  return scaled_by_thrust(fit_planar(rows),
                          {{"th1", scenario.vehicle.thrusters[simulator::kSurgeLeft].forward}});
}

// A parameter over the seeds, against the true value of the simulated vehicle.
struct IdentifiedParameter {
  std::string name;
  double truth = 0.0;
  double mean = 0.0;
  double root_mean_square_error = 0.0;
  double worst_error = 0.0;
  double mean_standard_error = 0.0;
  double coverage = 0.0;  // share of seeds with the truth inside the 90 % interval
};

struct IdentifyStudy {
  std::size_t seeds = 0;
  std::vector<IdentifiedParameter> parameters;
  double coverage = 0.0;           // over parameters and seeds
  std::vector<double> per_seed{};  // share of the parameters inside their intervals
  double mean_misfit = 0.0;
};

struct IdentifyStudyArguments {
  std::string scenario;
  std::size_t seeds = 20;
};

// Simulates and identifies all rows.
IdentifyStudy study_identification(const simulator::Scenario& first, std::size_t seeds,
                                   const std::function<bool(double)>& keep_going) {
  const std::vector<double> truth = truth_of(first);
  IdentifyStudy study;
  std::size_t inside_all = 0;
  std::size_t judged_all = 0;
  for (std::size_t i = 0; i < seeds; ++i) {
    simulator::Scenario scenario = first;
    scenario.seed = first.seed + i;
    const ParameterFit fit = identify_seed(scenario);
    study.parameters.resize(fit.parameters.size());
    std::size_t inside = 0;
    std::size_t judged = 0;
    for (std::size_t p = 0; p < fit.parameters.size(); ++p) {
      const FittedParameter& found = fit.parameters[p];
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
    if (!keep_going(static_cast<double>(i + 1) / static_cast<double>(seeds))) {
      break;
    }
  }
  const auto count = static_cast<double>(study.seeds);
  for (IdentifiedParameter& row : study.parameters) {
    row.mean /= count;
    row.root_mean_square_error = std::sqrt(row.root_mean_square_error / count);
    row.mean_standard_error /= count;
    row.coverage /= count;
  }
  study.coverage = static_cast<double>(inside_all) / static_cast<double>(judged_all);
  study.mean_misfit /= count;
  return study;
}

// Of a truth of 0 in the parameter's own unit.
std::string share_of(double part, double whole) {
  return std::abs(whole) > 1e-9 ? fmt::format("{:.2f} %", 100.0 * part / std::abs(whole))
                                : chart::significant(part);
}

std::string study_text(const IdentifyStudy& study) {
  chart::TextTable table{"Parameters over all seeds",
                         {"parameter", "truth", "mean", "rms error", "worst",
                          "mean standard\nerror", "in the 90 %\ninterval"},
                         {}};
  for (const IdentifiedParameter& row : study.parameters) {
    table.rows.push_back(
        {row.name, chart::significant(row.truth), chart::significant(row.mean),
         share_of(row.root_mean_square_error, row.truth), share_of(row.worst_error, row.truth),
         share_of(row.mean_standard_error, row.truth), fmt::format("{:.2f}", row.coverage)});
  }
  return chart::table_text(table) +
         fmt::format(
             "{} seeds; {:.3f} of all parameters in their 90 % intervals, {:.2f} in the "
             "worst seed; mean misfit {:.2f}\n",
             study.seeds, study.coverage, std::ranges::min(study.per_seed), study.mean_misfit);
}

void run_identify_study(const IdentifyStudyArguments& options) {
  require(options.seeds > 0, "--seeds", "has to be > 0");
  const simulator::Scenario scenario = simulator::read_scenario(options.scenario);
  if (scenario.log != simulator::LogKind::six) {
    simulator::require_plane(scenario.vehicle);
  }
  require(scenario.configurations.size() == 1, "scenario", "has to have one configuration");
  const IdentifyStudy study = run_watched("identifying", [&](const auto& keep_going) {
    return study_identification(scenario, options.seeds, keep_going);
  });
  cli::say("{}", study_text(study));
}

}  // namespace

void add_identify(CLI::App& app) {
  const auto [command, options] = cli::add_command<IdentifyStudyArguments>(
      app, "identify", "Simulate and identify from many seeds: errors and coverage of intervals",
      run_identify_study);
  cli::add_file(command, "scenario", options->scenario, "scenario of one configuration")
      ->required();
  command->add_option("--seeds", options->seeds, "from the scenario's own on")
      ->capture_default_str();
}

}  // namespace kelpie::lab
