// SPDX-License-Identifier: Apache-2.0
#include "log/read_log.hpp"
#include "log/ardusub.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "bag/open_bag.hpp"
#include "core/seconds.hpp"
#include "kelpie/core/error.hpp"
#include "log/dataset.hpp"
#include "log/held_table.hpp"
#include "log/pose_check.hpp"
#include "log/pose_instants.hpp"
#include "log/signal.hpp"
#include "log/validity.hpp"
#include "motion/signal_names.hpp"
#include "motion/states.hpp"

namespace kelpie::log {
namespace {

[[noreturn]] void refuse(const std::string& file, const std::string& field,
                         const std::string& message) {
  throw InputError({.file = file, .field = field}, message);
}

Signal signal_of(const SamplingPlan::Source& source, const bag::Series& series,
                 std::int64_t origin_ns) {
  Signal signal{.name = source.name,
                .from = source.from,
                .topic = series.topic,
                .times_s = {},
                .values = series.values[series.column(source.from)],
                .steps_back = series.steps_back,
                .longest_back_s = seconds(series.longest_back_ns)};
  for (const std::int64_t time : series.times_ns) {
    signal.times_s.push_back(seconds(time - origin_ns));
  }
  return signal;
}

// The earliest time by the clock that its first message has. One that is set while it is recorded
// leaves a silence of years in the times as sorted.
std::int64_t begin_ns(const bag::Series& series) {
  const std::vector<std::int64_t>& times = series.times_ns;
  auto begin = std::ranges::lower_bound(times, series.stored_first_ns);
  while (begin != times.begin() &&
         seconds(*begin - *std::prev(begin)) <= kTuning.longest_silence_s) {
    --begin;
  }
  return *begin;
}

// Of the column that `from` is in the series; nothing where its definition has none.
void add_unit(const bag::Series& series, const std::string& from, const std::string& column,
              std::map<std::string, std::string>& units) {
  if (const std::string& unit = series.units[series.column(from)]; !unit.empty()) {
    units[column] = unit;
  }
}

// Derivatives have the unit of what they are of, per s; what the user says goes before.
std::map<std::string, std::string> all_units(std::map<std::string, std::string> found,
                                             const StreamPlan& plan, const Roles& roles) {
  for (const StreamPlan::Derived& derived : plan.derived) {
    if (const auto of = found.find(derived.of); of != found.end()) {
      found[derived.name] = of->second + "/s";
    }
  }
  if (plan.pose) {
    for (const std::size_t axis : plan.pose->axes()) {
      const std::string name = StreamPlan::Pose::kVelocities[axis];
      found[name] = axis < 3 ? "m/s" : "rad/s";
      found[name + "dot"] = axis < 3 ? "m/s^2" : "rad/s^2";
    }
  }
  const auto converted = [&](const std::string& column, const std::string& text) {
    const auto [unit, factor] = si_unit({}, column, text);
    return std::pair(factor == 1.0 ? text : unit.text(), factor != 1.0);
  };
  for (const auto& [column, unit] : roles.units) {
    found[column] = converted(column, unit).first;
  }
  for (const StreamPlan::Derived& derived : plan.derived) {
    if (const auto of = roles.units.find(derived.of);
        of != roles.units.end() && converted(of->first, of->second).second) {
      found[derived.name] = found[derived.of] + "/s";
    }
  }
  return found;
}

// Whether accelerations come of the source.
bool is_velocity(const SamplingPlan& plan, const std::string& name) {
  return velocity_axis(name).has_value() ||
         std::ranges::count(plan.derived, name, &StreamPlan::Derived::of) > 0 ||
         (plan.pose && std::ranges::count(plan.pose->sources(), name) > 0);
}

// Without the messages whose topic calls itself invalid, those of values that stand for none, and
// those of `others`. Returns how many there are.
std::size_t drop_invalid(const bag::Series& series, const LogConfig& config, const Roles& roles,
                         Rows rows, Signal& signal) {
  const auto add = [&](const Rows& more) { rows.insert(rows.end(), more.begin(), more.end()); };
  add(missing_rows(signal.values, roles, {signal.name, signal.from}));
  if (velocity_axis(signal.name)) {
    add(mark_rows(signal.values, roles));
  }
  for (const auto& [name, least] : config.valid) {
    const std::size_t column = series.column(name);
    const bool is_of_signal = column < series.names.size() && is_velocity(config.plan, signal.name);
    for (std::size_t k = 0; is_of_signal && k < signal.values.size(); ++k) {
      if (!(series.values[column][k] >= least)) {
        rows.push_back(k);
      }
    }
  }
  drop_rows(rows, signal.values);
  std::ranges::sort(rows);
  return static_cast<std::size_t>(std::ranges::unique(rows).begin() - rows.begin());
}

// The velocities up to an axis that come in one message.
std::vector<std::span<const double>> velocities_of(const bag::Series& series,
                                                   const SamplingPlan& plan, std::size_t axes) {
  std::vector<std::span<const double>> velocities;
  for (const SamplingPlan::Source& source : plan.sources) {
    const std::size_t column = series.column(source.from);
    if (velocity_axis(source.name).value_or(axes) < axes && column < series.names.size()) {
      velocities.emplace_back(series.values[column]);
    }
  }
  return velocities;
}

// Messages of exact zeros in all velocities over ground, or with a frozen one.
Rows unmeasured_rows(const bag::Series& series, const SamplingPlan& plan,
                     const SamplingPlan::Source& source, const Roles& roles) {
  constexpr std::size_t kOverGround = 3;
  constexpr std::size_t kAll = 6;
  const std::optional<std::size_t> axis = velocity_axis(source.name);
  if (!axis) {
    return {};
  }
  Rows rows;
  if (*axis < kOverGround) {
    rows = zero_rows(velocities_of(series, plan, kOverGround), roles);
  }
  const std::vector<std::span<const double>> all = velocities_of(series, plan, kAll);
  const double* const own = series.values[series.column(source.from)].data();
  const auto place = std::ranges::find(all, own, [](const auto& one) { return one.data(); });
  const Rows frozen = frozen_rows(all, static_cast<std::size_t>(place - all.begin()), roles);
  rows.insert(rows.end(), frozen.begin(), frozen.end());
  return rows;
}

// Those of the plan's sources.
struct BagSignals {
  std::vector<Signal> signals;
  std::int64_t origin_ns = std::numeric_limits<std::int64_t>::max();  // where their times begin
  std::string losses;        // what of a damaged bag was lost
  std::size_t disarmed = 0;  // messages left out
  std::map<std::string, std::string> units;
};

// Pulses of a reversed motor, mirrored: now a pulse above the neutral one pushes as the frame's
// table says.
void mirror(Signal& signal, const ParameterMap& parameters, const std::string& source) {
  const std::size_t output = output_of(signal.from);
  if (output == 0) {
    return;
  }
  const std::optional<double> factor = pulse_factor(parameters, output);
  if (!factor) {
    throw InputError({.file = source, .line = 0, .field = "log.mirror_motors"},
                     "the log does not tell " + next_parameter(parameters, output) +
                         ", so the direction of " + signal.from +
                         " is unknown; [log.scale] takes directions by hand");
  }
  for (double& value : signal.values) {
    value = mirrored(value, *factor);
  }
}

BagSignals signals_of_bag(const LogSource& source, const LogConfig& config,
                          const bag::RowTimes& times, const Roles& roles) {
  std::vector<std::string> columns;
  for (const SamplingPlan::Source& column : config.plan.sources) {
    if (std::ranges::find(columns, column.from) == columns.end()) {
      columns.push_back(column.from);
    }
  }
  std::ranges::transform(config.valid, std::back_inserter(columns),
                         [](const auto& one) { return one.first; });
  const bag::MessageDefinitions definitions(source.definitions.empty() ? config.messages.string()
                                                                       : source.definitions);
  const std::unique_ptr<bag::MessageReader> bag = source.open_bag(times);
  ParameterMap parameters;
  const std::vector<bag::Series> all =
      bag::read_series(*bag, definitions, columns, config.clock, config.armed_only,
                       config.mirror_motors ? &parameters : nullptr);
  BagSignals found;
  found.losses = bag->losses_text();
  for (const bag::Series& series : all) {
    found.origin_ns = std::min(found.origin_ns, begin_ns(series));
    found.disarmed += series.disarmed;
  }
  for (const SamplingPlan::Source& column : config.plan.sources) {
    const bag::Series& series = bag::series_with(all, column.from);
    found.signals.push_back(signal_of(column, series, found.origin_ns));
    if (const std::size_t count =
            drop_invalid(series, config, roles, unmeasured_rows(series, config.plan, column, roles),
                         found.signals.back())) {
      found.losses += fmt::format("{}: {} of {} messages are no measurement of {}{}\n", source.path,
                                  count, series.times_ns.size(), column.name,
                                  count < series.times_ns.size()
                                      ? ""
                                      : ": no velocity was measured, nothing can be learned");
    }
    if (config.mirror_motors) {
      mirror(found.signals.back(), parameters, bag->source());
    }
    if (std::abs(column.scale) == 1.0) {  // else the user's units say what the scale gives
      add_unit(series, column.from, column.name, found.units);
    }
  }
  return found;
}

// Every column is a topic of its own: its empty cells have no samples.
std::vector<Signal> signals_of_table(const Table& table, const SamplingPlan& plan,
                                     const std::string& time) {
  if (const std::string known = row_clock(table, {.rate_hz = plan.rate_hz}).column;
      time.empty() && !known.empty()) {
    refuse(table.source, "time",
           "is missing; [log] has to name the column of the time, as in time = \"" + known + "\"");
  }
  const std::vector<double> times_s = row_times_s(table, time, plan.rate_hz);
  std::vector<Signal> signals;
  for (const SamplingPlan::Source& source : plan.sources) {
    const std::size_t column = table.find(source.from);
    table.require_numbers(column);
    Signal& signal = signals.emplace_back();
    signal.name = source.name;
    signal.from = source.from;
    signal.topic = source.from;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      if (std::isfinite(times_s[row])) {
        signal.times_s.push_back(times_s[row]);
        signal.values.push_back(table.columns[column][row]);
      }
    }
  }
  return signals;
}

// A table whose rows are samples, in units of the SI.
Log taken_log(Table table, Roles roles) {
  convert_units(table, roles.units);
  roles.units.clear();  // the table has them
  return {.table = std::move(table), .roles = std::move(roles)};
}

// Whether a table's rows can be samples; else why not.
bool can_be_taken(const Table& table, const Roles& roles, std::string& why_not) {
  const auto is_there = [&](const std::string& name) {
    return std::ranges::find(table.names, name) != table.names.end();
  };
  if (!roles.inputs.empty() && std::ranges::all_of(roles.inputs, is_there)) {
    return true;
  }
  try {
    Roles all = roles;
    all.also.clear();
    guess_roles(table, all);
    return true;
  } catch (const InputError& error) {
    why_not = InputError(error.place().field, error.message()).what();  // without the file
    return false;
  }
}

// Inputs that are pulses of servos, in whole µs to both sides of rest, rest at their middle unless
// the user knows better.
void add_neutral_pulses(const Table& table, Roles& roles) {
  for (const std::string& input : roles.inputs) {
    const auto found = std::ranges::find(table.names, input);
    if (found == table.names.end() || roles.actuators.contains(input)) {
      continue;
    }
    const auto column = static_cast<std::size_t>(found - table.names.begin());
    if (zeros_among_pulses(table.columns[column]) == 0) {
      roles.actuators[input] = {.neutral = kNeutralPulseUs};
    }
  }
}

// Whether the samples of a draft have all these columns.
bool gives(const Draft& draft, const std::vector<std::string>& inputs) {
  return draft.is_complete() && std::ranges::all_of(inputs, [&](const std::string& name) {
           return std::ranges::count(draft.config.roles.inputs, name) > 0;
         });
}

// What the caller wants, over what was guessed.
Roles over(const Roles& wanted, const Roles& drafted) {
  Roles roles = wanted;
  const auto fill = [](auto& value, const auto& otherwise) {
    value = value.empty() ? otherwise : value;
  };
  fill(roles.inputs, drafted.inputs);
  fill(roles.targets, drafted.targets);
  fill(roles.time, drafted.time);
  roles.units.insert(drafted.units.begin(), drafted.units.end());
  std::erase_if(roles.inputs, [&](const std::string& name) {
    return std::ranges::count(wanted.ignored, name) > 0;
  });
  roles.ignored.clear();  // rows of a draft have no other columns
  fill(roles.actuators, drafted.actuators);
  return roles;
}

// Rows whose window has one label keep the label; rows with several labels in the window get none.
void restore_labels(const Roles& roles, Table& table) {
  constexpr double kRounding = 1e-9;
  for (const std::string& name : {roles.configuration, roles.held_out}) {
    if (name.empty()) {
      continue;
    }
    for (double& mean : table.columns[table.find(name)]) {
      const double label = std::round(mean);
      mean = std::abs(mean - label) <= kRounding ? label : std::numeric_limits<double>::quiet_NaN();
    }
  }
}

// Roles with the units of the log's columns under the names of the columns in the rows: psi is yaw
// where a pose says so.
Roles with_units_of_rows(Roles roles, const StreamPlan& plan) {
  const std::map<std::string, std::string> given = roles.units;
  for (const auto& [column, unit] : given) {
    const bool is_of_row = std::ranges::count(plan.sources, column, &StreamPlan::Source::name) > 0;
    for (const StreamPlan::Source& source : plan.sources) {
      if (!is_of_row && source.from == column) {
        roles.units.erase(column);
        roles.units[source.name] = unit;
      }
    }
  }
  return roles;
}

Log sampled_log(const LogSource& source, bool is_of_bag, Table table, const LogConfig& config,
                const Roles& wanted) {
  const Roles roles = with_units_of_rows(wanted, config.plan);
  SamplingPlan plan = sampling_plan(config, roles);
  plan.with_instants = source.with_poses;
  const bag::RowTimes times = row_times(config, roles);
  if (is_of_bag && !times.time.empty() && !bag::may_lack_times(source.path)) {
    refuse(config.source, "log.time",
           "belongs to CSV files and MATLAB's; a bag has times of its own");
  }
  Log log{.table = {}, .roles = roles};
  if (plan.pose) {
    add_pose_targets(*plan.pose, log.roles);
  }
  BagSignals found;
  if (is_of_bag) {
    found = signals_of_bag(source, config, times, roles);
  } else {
    if (const auto unit = log.roles.units.find(times.time); unit != log.roles.units.end()) {
      convert_units(table, {*unit});
      log.roles.units.erase(unit);  // the time of the rows is in s
    }
    found.signals = signals_of_table(table, plan, times.time);
  }
  log.losses = std::move(found.losses);
  log.disarmed = found.disarmed;
  log.units = all_units(std::move(found.units), plan, log.roles);
  log.roles.units = row_units(plan, log.roles);
  Samples samples = sample(plan, std::move(found.signals), source.path);
  log.table = std::move(samples.table);
  log.instants = std::move(samples.instants);
  log.sampling = std::move(samples.report);
  if (plan.pose) {
    restore_labels(log.roles, log.table);
  }
  log.roles.time = "t";
  log.roles.rate_hz = 0.0;
  return log;
}

}  // namespace

std::map<std::string, std::string> row_units(const StreamPlan& plan, const Roles& roles) {
  std::map<std::string, std::string> units = all_units({}, plan, roles);
  const std::vector<std::string> columns = sampled_columns(plan);
  // Positions and quaternions are converted with the rest, but become other columns.
  const auto is_used_up = [&](const std::string& name) {
    return std::ranges::count(plan.sources, name, &StreamPlan::Source::name) > 0 &&
           std::ranges::count(columns, name) == 0;
  };
  std::erase_if(units, [&](const auto& unit) {
    return !roles.units.contains(unit.first) || is_used_up(unit.first);
  });
  return units;
}

std::unique_ptr<bag::MessageReader> LogSource::open_bag(const bag::RowTimes& times) const {
  return bag::open_bag(path, mode, times);
}

Dataset Log::dataset() const {
  Roles all = guess_roles(table, roles);
  if (sampling.sources.empty()) {  // a draft knows the pulses of messages
    add_neutral_pulses(table, all);
  }
  Dataset data = make_dataset(table, all);
  data.doubts = doubts;
  add_pose_instants(instants, data);
  for (const SamplingReport::OfDerived& derived : sampling.derived) {
    data.derived.push_back(derived.name);
  }
  if (!sampling.sources.empty()) {
    data.rate_hz = sampling.rate_hz;  // as asked for; stamps tell it only to rounding
  }
  return data;
}

bag::RowTimes row_times(const LogConfig& config, const Roles& roles) {
  return {.time = roles.time.empty() ? config.roles.time : roles.time,
          .rate_hz = roles.rate_hz > 0.0 ? roles.rate_hz : config.roles.rate_hz};
}

namespace {

// `table`: the content of a log that is no bag.
Log log_of(const LogSource& source, bool is_of_bag, Table table, const LogConfig& config,
           const Roles& roles) {
  const bool has_pose = !roles.pose.empty();
  if (has_pose && config.makes_samples()) {
    refuse(config.source, "--pose",
           "stands beside a [log] that names its signals; write pose = {...} there");
  }
  if (has_pose && is_of_bag) {
    refuse(source.path, "--pose",
           "names columns of a CSV file; for a recording write pose = {...} in [log]");
  }
  if (config.makes_samples()) {
    return sampled_log(source, is_of_bag, std::move(table), config, roles);
  }
  for (const std::string& name : is_of_bag ? std::vector<std::string>{} : roles.ignored) {
    table.find(name);
  }
  std::string why_not;
  if (!is_of_bag && !has_pose && can_be_taken(table, roles, why_not)) {
    return taken_log(std::move(table), roles);
  }
  Draft draft = is_of_bag ? draft_of(source) : draft_of(table, roles);
  if (!is_of_bag && !has_pose && !roles.inputs.empty() && !gives(draft, roles.inputs)) {
    return taken_log(std::move(table), roles);  // who uses it says what is missing
  }
  if (!draft.is_complete()) {
    const bool lacks_targets =
        !why_not.starts_with("targets:") || draft.config.roles.targets.empty();
    refuse(source.path, {}, draft.unclear(lacks_targets ? why_not : ""));
  }
  Log log = sampled_log(source, is_of_bag, std::move(table), draft.config,
                        over(roles, draft.config.roles));
  if (!has_pose) {  // which the caller has to name for every log
    log.draft = std::move(draft);
  }
  return log;
}

}  // namespace

Log read_log(const LogSource& source, const LogConfig& config, const Roles& roles) {
  const bool is_of_bag = bag::is_bag(source.path);
  std::string told;
  Table table = is_of_bag ? Table{} : read_table(source, roles, told);
  std::vector<Mistake> doubts;
  if (!is_of_bag && !config.makes_samples() && roles.pose.empty()) {
    doubts = check_pose(table, roles).mistakes;
  }
  Log log = log_of(source, is_of_bag, std::move(table), config, roles);
  log.losses += told;
  log.doubts = std::move(doubts);
  return log;
}

Reach read_reach(const LogSource& source, const LogConfig& config) {
  const BagSignals found = signals_of_bag(source, config, row_times(config, {}), {});
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
  const std::unique_ptr<bag::MessageReader> bag = source.open_bag();
  const std::vector<bag::Series> series = bag::read_series(*bag, definitions, columns, clock);
  Log log{.table = held_table(series, columns, source.path), .roles = {.time = "t"}};
  log.losses = bag->losses_text();
  for (const std::string& column : columns) {
    add_unit(bag::series_with(series, column), column, column, log.units);
  }
  return log;
}

}  // namespace kelpie::log
