// SPDX-License-Identifier: Apache-2.0
#include "cli/log_reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "bag/series.hpp"
#include "log/csv.hpp"

namespace kelpie::cli {
namespace {

[[noreturn]] void refuse(const std::string& file, const std::string& field,
                         const std::string& message) {
  throw InputError({.file = file, .line = 0, .field = field}, message);
}

double seconds(std::int64_t nanoseconds) {
  return static_cast<double>(nanoseconds) / 1e9;
}

log::Signal signal_of(const log::SamplingPlan::Source& source, const bag::Series& series,
                      std::int64_t origin_ns) {
  const auto column = std::ranges::find(series.names, source.from) - series.names.begin();
  log::Signal signal{.name = source.name,
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

std::vector<log::Signal> signals_of_bag(const BagOptions& source, const SamplingConfig& config) {
  std::vector<std::string> columns;
  for (const log::SamplingPlan::Source& column : config.plan.sources) {
    if (std::ranges::find(columns, column.from) == columns.end()) {
      columns.push_back(column.from);
    }
  }
  const bag::MessageDefinitions definitions(source.definitions.empty() ? config.messages.string()
                                                                       : source.definitions);
  const std::unique_ptr<bag::BagReader> bag = source.open();
  const std::vector<bag::Series> all = bag::read_series(*bag, definitions, columns, config.clock);
  print_losses(*bag);
  std::int64_t origin_ns = std::numeric_limits<std::int64_t>::max();
  for (const bag::Series& series : all) {
    origin_ns = std::min(origin_ns, series.times_ns.front());
  }
  std::vector<log::Signal> signals;
  for (const log::SamplingPlan::Source& column : config.plan.sources) {
    const auto series = std::ranges::find_if(all, [&](const bag::Series& one) {
      return std::ranges::find(one.names, column.from) != one.names.end();
    });
    signals.push_back(signal_of(column, *series, origin_ns));
  }
  return signals;
}

// Every column is a topic of its own: its empty cells have no samples.
std::vector<log::Signal> signals_of_table(const log::Table& table, const SamplingConfig& config,
                                          const std::string& time) {
  if (time.empty()) {
    refuse(table.source, "time", "is missing; [log] has to name the column of the time");
  }
  const std::size_t time_column = table.find(time);
  table.require_numbers(time_column);
  std::vector<log::Signal> signals;
  for (const log::SamplingPlan::Source& source : config.plan.sources) {
    const std::size_t column = table.find(source.from);
    table.require_numbers(column);
    log::Signal& signal = signals.emplace_back();
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

// Lags go by the targets; where none are named, by the derivatives.
std::vector<std::string> responses_of(const log::SamplingPlan& plan, const log::Roles& roles) {
  std::vector<std::string> names = roles.targets;
  for (const log::SamplingPlan::Derived& derived : plan.derived) {
    if (roles.targets.empty()) {
      names.push_back(derived.name);
    }
  }
  return names;
}

}  // namespace

Log read_log(const BagOptions& source, const ConfigFile& config, const log::Roles& roles) {
  const bool is_of_bag = bag::is_bag(source.path);
  if (!config.sampling.is_given()) {
    if (is_of_bag) {
      refuse(source.path, {},
             "is a bag; a file given by --config has to name the columns to make of it, in "
             "[log.states] and [log.commands] (`kelpie inspect` lists what there is)");
    }
    return {log::read_csv(source.path), roles, {}};
  }
  SamplingConfig sampling = config.sampling;
  sampling.plan.rate_hz = roles.rate_hz != 0.0 ? roles.rate_hz : config.roles.rate_hz;
  sampling.plan.responses = responses_of(sampling.plan, roles);
  if (sampling.plan.rate_hz == 0.0) {
    refuse(config.source, "log.rate", "is missing; at how many rows per second is the log taken?");
  }
  const std::string time = roles.time.empty() ? config.roles.time : roles.time;
  if (is_of_bag && !time.empty()) {
    refuse(config.source, "log.time", "belongs to CSV files; a bag has times of its own");
  }
  log::Samples samples =
      log::sample(sampling.plan,
                  is_of_bag ? signals_of_bag(source, sampling)
                            : signals_of_table(log::read_csv(source.path), sampling, time),
                  source.path);
  Log log{std::move(samples.table), roles, log::sampling_text(samples.report)};
  log.roles.time = "t";
  log.roles.rate_hz = 0.0;
  return log;
}

}  // namespace kelpie::cli
