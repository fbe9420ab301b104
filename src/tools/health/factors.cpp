// SPDX-License-Identifier: Apache-2.0
#include "health/factors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/seconds.hpp"
#include "health/effect_factors.hpp"
#include "kelpie/core/error.hpp"
#include "motion/states.hpp"

namespace kelpie::health {
namespace {

// Inputs of the equation: all but the slow columns.
struct DriveInputs {
  std::vector<std::size_t> places{};
  std::vector<std::string> names{};
  std::vector<std::size_t> velocities{};  // among `places`
  std::optional<std::size_t> volts{};     // of the dataset
  std::optional<std::size_t> density{};
  std::optional<std::size_t> depth{};
};

DriveInputs inputs_of(const log::Dataset& data, const DriveColumns& columns) {
  DriveInputs inputs;
  const std::array<std::pair<const std::string*, std::optional<std::size_t>*>, 3> slow{
      {{&columns.volts, &inputs.volts},
       {&columns.density, &inputs.density},
       {&columns.depth, &inputs.depth}}};
  for (std::size_t i = 0; i < data.input_names.size(); ++i) {
    const auto* const found = std::ranges::find_if(
        slow, [&](const auto& one) { return *one.first == data.input_names[i]; });
    if (found != slow.end()) {
      *found->second = i;
      continue;
    }
    if (std::ranges::find(columns.velocities, i) != columns.velocities.end()) {
      inputs.velocities.push_back(inputs.places.size());
    }
    inputs.places.push_back(i);
    inputs.names.push_back(data.input_names[i]);
  }
  return inputs;
}

std::vector<double> column_of(const log::Dataset& data, std::size_t input) {
  std::vector<double> values;
  for (std::size_t row = 0; row < data.rows(); ++row) {
    values.push_back(data.input(row)[input]);
  }
  return values;
}

DriveRows rows_of(const log::Dataset& data, const DriveInputs& inputs, std::size_t begin,
                  std::size_t end) {
  DriveRows rows;
  for (std::size_t row = begin; row < end; ++row) {
    rows.times_s.push_back(data.times_s[row]);
    for (const std::size_t place : inputs.places) {
      rows.inputs.push_back(data.input(row)[place]);
    }
    if (inputs.volts) {
      rows.volts.push_back(data.input(row)[*inputs.volts]);
    }
    if (inputs.density) {
      rows.density.push_back(data.input(row)[*inputs.density]);
    }
  }
  return rows;
}

Episode episode_of(const DriveLog& log, const DriveRows& rows) {
  const double first = rows.times_s.front();
  const double last = rows.times_s.back();
  return {.mission = log.mission,
          .name = log.mission,
          .day = log.day + 0.5 * (first + last) / kSecondsPerDay,
          .hours = (last - first) / kSecondsPerHour};
}

// The dives of all logs, or the logs.
void cut(const std::vector<DriveLog>& logs, const DriveInputs& inputs, HealthTable& table,
         std::vector<DriveRows>& drives) {
  for (const DriveLog& log : logs) {
    std::vector<std::pair<std::size_t, std::size_t>> parts{{0, log.data.rows()}};
    if (inputs.depth) {
      parts = find_dives(column_of(log.data, *inputs.depth));
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
      drives.push_back(rows_of(log.data, inputs, parts[i].first, parts[i].second));
      table.episodes.push_back(episode_of(log, drives.back()));
      if (inputs.depth) {
        table.episodes.back().name += fmt::format(", dive {}", i + 1);
      }
    }
  }
}

Quantity quantity_of(const Effect& effect, const std::vector<std::string>& names) {
  const std::string& column = names[effect.input];
  const std::optional<std::size_t> axis = velocity_axis(column);
  const std::string name = axis ? std::string(kAxisTexts.at(*axis)) : column;
  switch (effect.kind) {
    case EffectKind::damping:
      return {name + " drag", ""};
    case EffectKind::command:
      return {column + " gain", ""};
    case EffectKind::constant:
      break;
  }
  return axis.value_or(0) > 2 ? Quantity{name + " trim", "rad/s²"}
                              : Quantity{name + " force", "m/s²"};
}

void remark_on_slow(const EffectFactors& found, const DriveInputs& inputs, HealthTable& table) {
  if (inputs.density) {
    const auto [low, high] = found.density;
    table.remarks.push_back(
        fmt::format("drag and gains are for water of {:.1f} kg/m³; the logs have {:.1f} to {:.1f}",
                    0.5 * (low + high), low, high));
  }
  if (inputs.volts) {
    const auto [low, high] = found.volts;
    table.remarks.push_back(
        found.exponent
            ? fmt::format("gains are for {:.2f} V and go with the power {:.2f} of the supply, "
                          "{:.2f} to {:.2f} V in the logs",
                          0.5 * (low + high), *found.exponent, low, high)
            : fmt::format("the supply, {:.2f} to {:.2f} V in the logs, varies too little to tell "
                          "its effect",
                          low, high));
  }
}

}  // namespace

HealthTable judge_drives(const std::vector<DriveLog>& logs, const DriveColumns& columns) {
  const log::Dataset& first = logs.front().data;
  const DriveInputs inputs = inputs_of(first, columns);
  HealthTable table;
  std::vector<DriveRows> drives;
  cut(logs, inputs, table, drives);
  const EffectFactors found = in_file(first.source, [&] {
    return fit_factors(drives, inputs.names, inputs.velocities, kLongestStep / first.rate_hz);
  });
  for (const Effect& effect : found.effects) {
    table.quantities.push_back(quantity_of(effect, inputs.names));
  }
  for (const std::vector<EffectFactor>& factors : found.drives) {
    std::vector<Estimate> estimates;
    for (const EffectFactor& factor : factors) {
      estimates.push_back({factor.value, factor.error});
    }
    table.estimates.push_back(std::move(estimates));
  }
  remark_on_slow(found, inputs, table);
  return table;
}

}  // namespace kelpie::health
