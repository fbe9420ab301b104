// SPDX-License-Identifier: Apache-2.0
#include "log/read_log.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "kelpie/core/error.hpp"
#include "log/csv.hpp"
#include "log/held_table.hpp"

namespace kelpie::log {
namespace {

[[noreturn]] void refuse(const std::string& file, const std::string& field,
                         const std::string& message) {
  throw InputError({.file = file, .line = 0, .field = field}, message);
}

double seconds(std::int64_t nanoseconds) {
  return static_cast<double>(nanoseconds) / 1e9;
}

Signal signal_of(const SamplingPlan::Source& source, const bag::Series& series,
                 std::int64_t origin_ns) {
  const auto column = std::ranges::find(series.names, source.from) - series.names.begin();
  Signal signal{.name = source.name,
                .from = source.from,
                .topic = series.topic,
                .times_s = {},
                .values = series.values[static_cast<std::size_t>(column)],
                .steps_back = series.steps_back,
                .longest_back_s = seconds(series.longest_back_ns)};
  for (const std::int64_t time : series.times_ns) {
    signal.times_s.push_back(seconds(time - origin_ns));
  }
  return signal;
}

// Those of the plan's sources.
struct BagSignals {
  std::vector<Signal> signals;
  std::int64_t origin_ns = std::numeric_limits<std::int64_t>::max();  // where their times begin
  std::string losses;  // what of a damaged bag was lost
};

BagSignals signals_of_bag(const LogSource& source, const LogConfig& config) {
  std::vector<std::string> columns;
  for (const SamplingPlan::Source& column : config.plan.sources) {
    if (std::ranges::find(columns, column.from) == columns.end()) {
      columns.push_back(column.from);
    }
  }
  const bag::MessageDefinitions definitions(source.definitions.empty() ? config.messages.string()
                                                                       : source.definitions);
  const std::unique_ptr<bag::BagReader> bag = source.open_bag();
  const std::vector<bag::Series> all = bag::read_series(*bag, definitions, columns, config.clock);
  BagSignals found;
  found.losses = bag->losses_text();
  for (const bag::Series& series : all) {
    found.origin_ns = std::min(found.origin_ns, series.times_ns.front());
  }
  for (const SamplingPlan::Source& column : config.plan.sources) {
    const auto series = std::ranges::find_if(all, [&](const bag::Series& one) {
      return std::ranges::find(one.names, column.from) != one.names.end();
    });
    found.signals.push_back(signal_of(column, *series, found.origin_ns));
  }
  return found;
}

// Every column is a topic of its own: its empty cells have no samples.
std::vector<Signal> signals_of_table(const Table& table, const SamplingPlan& plan,
                                     const std::string& time) {
  if (time.empty()) {
    refuse(table.source, "time", "is missing; [log] has to name the column of the time");
  }
  const std::size_t time_column = table.find(time);
  table.require_numbers(time_column);
  std::vector<Signal> signals;
  for (const SamplingPlan::Source& source : plan.sources) {
    const std::size_t column = table.find(source.from);
    table.require_numbers(column);
    Signal& signal = signals.emplace_back();
    signal.name = source.name;
    signal.from = source.from;
    signal.topic = source.from;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      if (std::isfinite(table.columns[time_column][row])) {
        signal.times_s.push_back(table.columns[time_column][row]);
        signal.values.push_back(table.columns[column][row]);
      }
    }
  }
  return signals;
}

}  // namespace

std::unique_ptr<bag::BagReader> LogSource::open_bag() const {
  return bag::open_bag(path, recover ? bag::ReadMode::recover : bag::ReadMode::strict);
}

Dataset Log::dataset() const {
  Dataset data = make_dataset(table, guess_roles(table, roles));
  if (!sampling.sources.empty()) {
    data.rate_hz = sampling.rate_hz;  // as asked for; stamps tell it only to rounding
  }
  return data;
}

Log read_log(const LogSource& source, const LogConfig& config, const Roles& roles) {
  const bool is_of_bag = bag::is_bag(source.path);
  if (!config.makes_samples()) {
    if (is_of_bag) {
      refuse(source.path, {},
             "is a bag; a file given by --config has to name the columns to make of it, in "
             "[log.states] and [log.commands] (`kelpie inspect` lists what there is)");
    }
    return {.table = read_csv(source.path), .roles = roles};
  }
  const SamplingPlan plan = sampling_plan(config, roles);
  const std::string time = roles.time.empty() ? config.roles.time : roles.time;
  if (is_of_bag && !time.empty()) {
    refuse(config.source, "log.time", "belongs to CSV files; a bag has times of its own");
  }
  Log log{.table = {}, .roles = roles};
  BagSignals found;
  if (is_of_bag) {
    found = signals_of_bag(source, config);
  } else {
    found.signals = signals_of_table(read_csv(source.path), plan, time);
  }
  log.losses = std::move(found.losses);
  Samples samples = sample(plan, std::move(found.signals), source.path);
  log.table = std::move(samples.table);
  log.sampling = std::move(samples.report);
  log.roles.time = "t";
  log.roles.rate_hz = 0.0;
  return log;
}

Reach read_reach(const LogSource& source, const LogConfig& config) {
  const BagSignals found = signals_of_bag(source, config);
  Reach reach{.origin_ns = found.origin_ns, .end_s = std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < found.signals.size(); ++k) {
    const Signal& signal = found.signals[k];
    std::size_t last = signal.values.size();
    while (last > 0 && !std::isfinite(signal.values[last - 1])) {
      --last;
    }
    if (last == 0) {
      refuse(source.path, signal.from, "has no finite value in any message");
    }
    reach.end_s = std::min(reach.end_s,
                           signal.times_s[last - 1] - config.plan.sources[k].lag_s.value_or(0.0));
  }
  return reach;
}

Log read_columns(const LogSource& source, std::span<const std::string> columns, bag::Clock clock) {
  const bag::MessageDefinitions definitions(source.definitions);
  const std::unique_ptr<bag::BagReader> bag = source.open_bag();
  const std::vector<bag::Series> series = bag::read_series(*bag, definitions, columns, clock);
  Log log{.table = held_table(series, columns, source.path), .roles = {.time = "t"}};
  log.losses = bag->losses_text();
  return log;
}

}  // namespace kelpie::log
