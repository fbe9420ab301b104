// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cli/output.hpp"
#include "file/atomic_file.hpp"
#include "lab/commands.hpp"
#include "lab/diagnosis_study.hpp"
#include "log/dataset.hpp"
#include "simulator/scenario_file.hpp"
#include "simulator/simulation.hpp"
#include "study/simulated_log.hpp"

namespace kelpie::lab {
namespace {

constexpr double kRunSeconds = 50.0;
constexpr double kBetweenRunsSeconds = 60.0;
constexpr std::size_t kRuns = 10;  // of each stretch of one vehicle

// A simulated vehicle that changes between two runs, by a case of diagnosis_cases().
struct Drive {
  const char* name;
  const char* of = "";     // DiagnosisCase::name; empty: nothing changes
  int effect = 0;          // DiagnosisCase::effect
  bool returns = false;    // the nominal vehicle drives again at the end
  bool of_sensor = false;  // measured accelerations are spoilt, too: no truth to compare with
  const char* meaning = "";
};

constexpr std::array kDrives{
    Drive{.name = "sim-nominal", .meaning = "nothing changes"},
    Drive{.name = "sim-thruster",
          .of = "thruster th2",
          .effect = 60,
          .meaning = "the right surge thruster loses 60 % of its thrust"},
    Drive{.name = "sim-drag", .of = "drag sway", .effect = 80, .meaning = "drag in sway × 1.8"},
    Drive{.name = "sim-load",
          .of = "load",
          .effect = 40,
          .meaning = "a neutral load, 40 % of the inertia in surge"},
    Drive{.name = "sim-tether",
          .of = "tether",
          .effect = 40,
          .meaning = "a tether pulls at the stern, 40 % of the greatest thrust in sway"},
    Drive{.name = "sim-sensor",
          .of = "scale u",
          .effect = 40,
          .of_sensor = true,
          .meaning = "surge velocity reads × 1.4"},
    Drive{.name = "sim-return",
          .of = "thruster th2",
          .effect = 80,
          .returns = true,
          .meaning = "the right surge thruster loses 80 % of its thrust, and is repaired"},
};

struct BenchmarkArguments {
  std::string scenario;
  std::uint64_t seed = 1;
  std::string out;
};

std::vector<simulator::Configuration> configurations_of(const Drive& drive,
                                                        const simulator::Scenario& scenario) {
  std::vector<simulator::Configuration> found(1);
  if (drive.of[0] != '\0') {
    const std::vector<DiagnosisCase> cases = diagnosis_cases(scenario.vehicle);
    const auto at = std::ranges::find_if(cases, [&](const DiagnosisCase& one) {
      return one.name == drive.of && one.effect == drive.effect;
    });
    found.push_back(at->configuration);
  }
  return found;
}

// Rows of a run that begins at rest, after the table's rows.
void append_run(log::Table& table, const simulator::Scenario& run, std::size_t configuration,
                std::size_t number) {
  log::Table rows = study::log_table(simulator::simulate(run), table.source);
  const auto begin = static_cast<double>(number) * (kRunSeconds + kBetweenRunsSeconds);
  std::ranges::for_each(rows.columns[0], [&](double& time_s) { time_s += begin; });
  std::ranges::fill(rows.columns[1], static_cast<double>(configuration));
  rows.names.emplace_back("run");
  rows.columns.emplace_back(rows.rows(), static_cast<double>(number));
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    table.lines.push_back(table.lines.size() + 2);  // below the header
  }
  table.names = rows.names;
  table.columns.resize(rows.columns.size());
  for (std::size_t i = 0; i < rows.columns.size(); ++i) {
    table.columns[i].insert(table.columns[i].end(), rows.columns[i].begin(), rows.columns[i].end());
  }
}

// Columns t, conf, u, v, r, th1, th2, th3, accelerations, true accelerations, run.
log::Table drive_log(const Drive& drive, const simulator::Scenario& scenario, std::uint64_t seed) {
  const std::vector<simulator::Configuration> configurations = configurations_of(drive, scenario);
  std::vector<std::size_t> stretches(configurations.size());
  std::ranges::generate(stretches, [next = std::size_t{0}]() mutable { return next++; });
  if (drive.returns) {
    stretches.push_back(0);
  }
  log::Table table;
  table.source = drive.name;
  std::size_t number = 0;
  for (const std::size_t configuration : stretches) {
    for (std::size_t i = 0; i < kRuns; ++i, ++number) {
      simulator::Scenario run = scenario;
      run.seed = seed * 1000 + number;
      run.configurations = {configurations[configuration]};
      run.phases = {{.duration_s = kRunSeconds}};
      append_run(table, run, configuration, number);
    }
  }
  return table;
}

std::string manifest_of(const Drive& drive, const simulator::Scenario& scenario,
                        std::uint64_t seed) {
  std::string text = fmt::format(
      "\n[[data]]  # {}\nname = \"{}\"\nfiles = [\"{}.csv\"]\n"
      "inputs = [\"u\", \"v\", \"r\", \"th1\", \"th2\", \"th3\"]\n"
      "targets = [\"udot\", \"vdot\", \"rdot\"]\ntime = \"t\"\nrate = {}\nrun = \"run\"\n"
      "configuration = \"conf\"\nsimulated = true\nlicense = \"Apache-2.0\"\n"
      "origin = \"kelpie-lab benchmark, seed {}: {}\"\n",
      drive.meaning, drive.name, drive.name, scenario.rate_hz, seed, drive.meaning);
  if (!drive.of_sensor) {
    text += "truth = [\"udot_true\", \"vdot_true\", \"rdot_true\"]\n";
  }
  const bool changes = drive.of[0] != '\0';
  text += changes ? "tracks = [\"anytime\", \"open_loop\", \"changes\", \"cost\"]\n"
                  : "tracks = [\"anytime\", \"open_loop\", \"rates\", \"hostile\", \"cost\"]\n";
  return text;
}

void run_benchmark(const BenchmarkArguments& options) {
  const std::string file = scenario_file(options.scenario, "diagnosis.toml");
  const simulator::Scenario scenario = simulator::read_scenario(file);
  in_file(file, [&] { simulator::require_plane(scenario.vehicle); });
  std::string manifest =
      "# SPDX-License-Identifier: Apache-2.0\n# Simulated drives for kelpie.benchmark.\n";
  std::vector<std::string> names{"simulated.toml"};
  for (const Drive& drive : kDrives) {
    names.push_back(fmt::format("{}.csv", drive.name));
    manifest += manifest_of(drive, scenario, options.seed);
  }
  const file::OutFolder folder = cli::take_out_folder(options.out, names, {file});
  file::FileSet files{{names[0], manifest}};
  for (const Drive& drive : kDrives) {
    files[fmt::format("{}.csv", drive.name)] =
        log::csv_text(drive_log(drive, scenario, options.seed));
  }
  file::write_files_whole(folder.path(), files);
  const std::string path = (folder.path() / names[0]).string();
  cli::say(
      "{} simulated drives\nmanifest: {}\nmeasure:  python3 -m kelpie.benchmark run {} --out "
      "FOLDER\n",
      kDrives.size(), path, path);
}

}  // namespace

void add_benchmark(CLI::App& app) {
  const auto [command, options] = cli::add_command<BenchmarkArguments>(
      app, "benchmark", "Write the simulated drives of the open benchmark, with their manifest",
      run_benchmark);
  cli::add_file(command, "--scenario", options->scenario,
                "Scenario with vehicle, noise, excitation and rate (scenarios/diagnosis.toml)");
  command->add_option("--seed", options->seed, "Of the drives")->capture_default_str();
  cli::add_out(command, options->out, "folder for simulated.toml and the drives as CSV files");
}

}  // namespace kelpie::lab
