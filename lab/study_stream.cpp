// SPDX-License-Identifier: Apache-2.0
#include "lab/study_stream.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "log/read_log.hpp"
#include "study/simulated_log.hpp"
#include "vehicle/scenario_file.hpp"
#include "vehicle/simulation.hpp"

namespace kelpie::lab {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExtension = ".toml";
constexpr double kRealRateHz = 4.0;

std::vector<std::string> scenario_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == kExtension) {
      names.push_back(entry.path().stem().string());
    }
  }
  std::ranges::sort(names);
  return names;
}

// The time up to which each row's phase lasts tells which phase that is.
bool at_full_amplitude(const vehicle::Scenario& scenario, double time_s) {
  constexpr double kHalfTickS = 0.005;
  double end_s = 0.0;
  for (const vehicle::Phase& phase : scenario.phases) {
    end_s += phase.duration_s;
    if (time_s < end_s + kHalfTickS) {
      return phase.amplitude >= 1.0;
    }
  }
  return true;
}

}  // namespace

vehicle::Scenario planned_scenario(const fs::path& folder, const std::string& name, double share) {
  const fs::path file = folder / (name + kExtension);
  if (!fs::exists(file)) {
    const std::vector<std::string> names = scenario_names(folder);
    throw InputError({.file = folder.string(), .line = 0, .field = {}},
                     "there is no scenario '" + name + "'" + did_you_mean(name, names) +
                         (names.empty() ? "; the folder has none" : "; it has ") +
                         join_text(names, ", "));
  }
  vehicle::Scenario scenario = vehicle::read_scenario(file);
  for (vehicle::Phase& phase : scenario.phases) {
    phase.duration_s = std::max(1.0, std::round(phase.duration_s * share));
  }
  return scenario;
}

SeedData simulated_data(vehicle::Scenario scenario, const std::string& source, std::uint64_t seed,
                        bool full_range_only) {
  scenario.seed = seed;
  const log::Table table = study::log_table(vehicle::simulate(scenario), source);
  SeedData result = split_data(log::make_dataset(table, log::guess_roles(table, {})), seed);
  if (full_range_only) {
    for (study::Split& split : result.splits) {
      std::erase_if(split.held_out, [&](std::size_t row) {
        return !at_full_amplitude(scenario, result.data.times_s[row]);
      });
    }
  }
  return result;
}

log::Dataset real_data(const ReproductionPlan& plan) {
  const std::string file = (plan.data / kRealLogName).string();
  return log::read_log({.path = file}, {}, {.rate_hz = kRealRateHz}).dataset();
}

log::Dataset first_rows(log::Dataset data, std::size_t rows) {
  if (rows > 0 && rows < data.rows()) {
    data.inputs.resize(rows * data.input_names.size());
    data.targets.resize(rows * data.target_names.size());
    data.times_s.resize(rows);
    data.configurations.resize(rows);
  }
  return data;
}

SeedData split_data(log::Dataset data, std::uint64_t seed) {
  SeedData result{std::move(data), {}};
  for (const study::SplitKind kind : kSplitKinds) {
    result.splits.push_back(study::make_split(result.data, {.kind = kind, .seed = seed}));
  }
  return result;
}

log::Dataset one_target(const log::Dataset& data, std::size_t axis) {
  log::Dataset one = data;
  one.target_names = {data.target_names[axis]};
  one.targets.clear();
  for (std::size_t row = 0; row < data.rows(); ++row) {
    one.targets.push_back(data.target(row)[axis]);
  }
  return one;
}

}  // namespace kelpie::lab
