// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "chart/text_table.hpp"
#include "lab/commands.hpp"
#include "lab/drive_study.hpp"
#include "lab/json_table.hpp"
#include "simulator/scenario_file.hpp"

namespace kelpie::lab {
namespace {

struct PlanArguments {
  std::string scenario;
  DriveStudyPlan plan;
  std::uint64_t seed = 1;
  double rate_hz = 0.0;
  double percent = 5.0;
  std::string out = "out/plan";
};

// The row of a driver: an entry per seed of each number.
file::Json driver_json(const DriveStudy& study, std::size_t driver) {
  const auto every = [&](auto value) {
    return file::list(study.seeds, [&](const auto& seed) { return value(seed[driver]); });
  };
  const auto extent = [&](double study::DriveExtent::*number) {
    return every([=](const DriveOutcome& one) { return file::number(one.extent.*number); });
  };
  return {{"name", driver_name(kDrivers[driver])},
          {"told", every([](const DriveOutcome& one) { return file::Json(one.told); })},
          {"told_s", every([](const DriveOutcome& one) { return file::number(one.told_s); })},
          {"error", every([](const DriveOutcome& one) { return file::number(one.error); })},
          {"expected_over_identified",
           every([](const DriveOutcome& one) { return file::number(one.expected); })},
          {"farthest_m", extent(&study::DriveExtent::farthest_m)},
          {"fastest_m_s", extent(&study::DriveExtent::fastest_m_s)},
          {"depth_m", extent(&study::DriveExtent::depth_m)},
          {"tilt_rad", extent(&study::DriveExtent::tilt_rad)},
          {"times_s", every([](const DriveOutcome& one) { return file::numbers(one.times_s); })},
          {"worst_share", every([](const DriveOutcome& one) { return file::numbers(one.worst); })}};
}

file::Json study_rows(const DriveStudy& study) {
  file::Json rows = file::Json::array();
  for (std::size_t driver = 0; driver < kDrivers.size(); ++driver) {
    rows.push_back(driver_json(study, driver));
  }
  return rows;
}

double most_of(const file::Json& values) {
  double most = 0.0;
  for (const file::Json& value : values) {
    most = std::max(most, value.get<double>());
  }
  return most;
}

std::string drivers_table(const DriveStudyPlan& plan, const file::Json& rows) {
  const auto most = [](const char* name, const char* format) {
    return [=](const file::Json& row) {
      return fmt::format(fmt::runtime(format), most_of(row[name]));
    };
  };
  const std::vector<JsonColumn> columns{
      {"driver", [](const file::Json& row) { return row["name"].get<std::string>(); }},
      {"told in",
       [](const file::Json& row) {
         return fmt::format("{} of {}", std::ranges::count(row["told"], file::Json(true)),
                            row["told"].size());
       }},
      column("median s", "/told_s", fixed("{:.0f}")),
      {"longest s", most("told_s", "{:.0f}")},
      column("rms error\nmedian %", "/error",
             [](double share) { return fmt::format("{:.2f}", 100.0 * share); }),
      {"farthest m", most("farthest_m", "{:.2f}")},
      {"fastest m/s", most("fastest_m_s", "{:.3f}")},
      {"deepest m", most("depth_m", "{:.2f}")},
      {"greatest tilt rad", most("tilt_rad", "{:.2f}")}};
  chart::TextTable table = json_table(
      fmt::format("Time until `kelpie identify` tells all that is wanted to ±{:g} %, after {:g} s "
                  "of driving before, {} seeds (simulation); bounds {:g} m, {:g} m/s",
                  100.0 * plan.share, plan.first_s, plan.seeds, plan.bounds.radius_m,
                  plan.bounds.speed_m_s),
      columns, rows);
  table.whole = true;
  return chart::table_text(table);
}

void run_plan(const PlanArguments& options) {
  DriveStudyPlan plan = options.plan;
  plan.scenario = simulator::read_scenario(scenario_file(options.scenario, "identify.toml"));
  if (plan.scenario.log != simulator::LogKind::six) {
    simulator::require_plane(plan.scenario.vehicle);
  }
  plan.scenario.seed = options.seed;
  if (options.rate_hz > 0.0) {
    plan.scenario.rate_hz = options.rate_hz;
  }
  plan.share = options.percent / 100.0;
  run_study({options.out, "plan", "driving", {options.scenario}}, plan, study_drives,
            [&](const DriveStudy& study) {
              const file::Json rows = study_rows(study);
              const file::Json document = {{"format", "kelpie-plan-study"},
                                           {"version", 1},
                                           {"simulated", true},
                                           {"first_seed", options.seed},
                                           {"rate_hz", plan.scenario.rate_hz},
                                           {"share", plan.share},
                                           {"first_s", plan.first_s},
                                           {"leg_s", plan.leg_s},
                                           {"time_s", plan.bounds.time_s},
                                           {"radius_m", plan.bounds.radius_m},
                                           {"speed_m_s", plan.bounds.speed_m_s},
                                           {"bound_depth_m", plan.bounds.depth_m},
                                           {"bound_tilt_rad", plan.bounds.tilt_rad},
                                           {"drivers", rows}};
              return StudyReport{drivers_table(plan, rows), file::json_text(document, 1)};
            });
}

}  // namespace

void add_plan(CLI::App& app) {
  const auto [command, options] = cli::add_command<PlanArguments>(
      app, "plan",
      "Time to identify the simulated vehicle by planned, random and a pilot's driving", run_plan);
  cli::add_file(command, "--scenario", options->scenario,
                "scenario of one configuration, in the plane or on six axes; else "
                "scenarios/identify.toml");
  command->add_option("--rate", options->rate_hz, "rows per second; else the scenario's")
      ->check(CLI::PositiveNumber);
  command->add_option("--tell", options->plan.tell, "parameters, as of `kelpie plan`")
      ->delimiter(',');
  command->add_option("--percent", options->percent, "half width of the 90 % intervals")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--first", options->plan.first_s, "driving before, all alike [s]")
      ->capture_default_str();
  command->add_option("--leg", options->plan.leg_s, "after which is identified again [s]")
      ->capture_default_str();
  command->add_option("--check", options->plan.check_s, "between identifications that judge [s]")
      ->capture_default_str();
  command->add_option("--seconds", options->plan.bounds.time_s, "longest drive [s]")
      ->capture_default_str();
  command->add_option("--speed", options->plan.bounds.speed_m_s, "greatest [m/s]")
      ->capture_default_str();
  command->add_option("--radius", options->plan.bounds.radius_m, "space [m]")
      ->capture_default_str();
  command->add_option("--depth", options->plan.bounds.depth_m, "greatest change, on six axes [m]")
      ->capture_default_str();
  command->add_option("--tilt", options->plan.bounds.tilt_rad, "greatest, on six axes [rad]")
      ->capture_default_str();
  add_seeds(command, options->plan.seeds, "of noise and drives");
  add_run_options(command, options->seed, options->plan.threads, options->out, "plan.json");
}

}  // namespace kelpie::lab
