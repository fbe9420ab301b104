// SPDX-License-Identifier: Apache-2.0
#include "live/configuration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include "bag/topic_columns.hpp"
#include "core/seconds.hpp"
#include "core/text.hpp"
#include "format/settings_file.hpp"
#include "kelpie/alignment/alignment.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"
#include "kelpie/stream/sample_stream.hpp"
#include "live/row_reader.hpp"
#include "live/tuning.hpp"
#include "log/draft.hpp"
#include "motion/states.hpp"
#include "study/identification.hpp"

namespace kelpie::live {
namespace {

constexpr double kLeastThrust = 1e-12;  // N per square of a unit, such as µs

double number_between(const file::TomlNode& value, double least, double most,
                      const std::string& unit) {
  const double number = value.number("a number of " + unit);
  if (!(number >= least) || number > most) {
    value.refuse(fmt::format("is out of range; it has to be from {} to {} {}", least, most, unit));
  }
  return number;
}

double seconds_between(const file::TomlNode& value) {
  return number_between(value, kTuning.least_pause_s, kTuning.longest_pause_s, "s");
}

std::string alignment_wish(const file::TomlNode& value) {
  if (value.type() != file::TomlNode::Type::text) {
    const double seconds = value.number(R"("auto", "none" or a number of s)");
    if (std::abs(seconds) > Alignment::kMostS) {
      value.refuse(fmt::format("is out of range; it has to lie within ±{} s", Alignment::kMostS));
    }
    return number_text(seconds);
  }
  std::string text = value.text();
  if (text != "auto" && text != "none") {
    value.refuse("'" + text + R"(' has to be "auto", "none" or a number of s)");
  }
  return text;
}

Frozen frozen_from(const file::TomlNode& value) {
  const std::string text = value.text(R"("skip" or "learn")");
  if (text != "skip" && text != "learn") {
    value.refuse("'" + text + R"(' has to be "skip" or "learn")");
  }
  return text == "skip" ? Frozen::skip : Frozen::learn;
}

// It can stand in a query, a cookie and a header, and takes long to guess.
bool is_good_token(const std::string& token) {
  return 16 <= token.size() && token.size() <= 128 &&
         token.find_first_not_of(
             "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_") ==
             std::string::npos;
}

// A port may be given as a number.
void endpoint(const file::TomlNode& value, std::string& text) {
  text = value.type() == file::TomlNode::Type::text
             ? value.text()
             : number_text(value.number("a port, or \"host:port\""));
  file::located(value, [&] { return parse_endpoint(text, ""); });
}

ParameterSettings read_parameters(const file::TomlNode& table) {
  table.table({"tell", "percent", "thrusters", "thrust"});
  ParameterSettings settings;
  if (table.has("tell")) {
    settings.tell = file::texts_of(table["tell"], "a list of parameters");
  }
  if (table.has("thrusters")) {
    settings.thrusters = file::texts_of(table["thrusters"], "a list of inputs");
  }
  if (table.has("percent")) {
    settings.percent = number_between(table["percent"], 0.1, 100.0, "%");
  }
  if (table.has("thrust")) {
    for (const file::TomlNode& value : table["thrust"].members("a table, as in {th1 = 0.0262}")) {
      settings.thrust.emplace_back(value.key(),
                                   number_between(value, kLeastThrust, study::kMostThrust, "N"));
    }
  }
  return settings;
}

LiveSettings read_live(const file::TomlNode& live) {
  live.table({"out", "checkpoint", "align", "frozen", "record", "plotjuggler", "page", "token",
              "status", "nominal", "block", "dds", "mavlink", "valid", "parameters", "heading"});
  LiveSettings settings;
  const auto text = [&](const char* key, std::string& value) {
    if (live.has(key)) {
      value = live[key].text();
    }
  };
  const auto seconds = [&](const char* key, double& value) {
    if (live.has(key)) {
      value = seconds_between(live[key]);
    }
  };
  text("out", settings.out);
  text("record", settings.record);
  text("nominal", settings.nominal);
  text("block", settings.block);
  text("heading", settings.heading);
  seconds("checkpoint", settings.checkpoint_s);
  seconds("status", settings.status_s);
  if (live.has("dds")) {
    settings.dds = live["dds"];
  }
  if (live.has("mavlink")) {
    settings.mavlink = live["mavlink"];
  }
  if (live.has("align")) {
    settings.align = alignment_wish(live["align"]);
  }
  if (live.has("frozen")) {
    settings.frozen = frozen_from(live["frozen"]);
  }
  for (const auto& [key, value] : {std::pair{"plotjuggler", &LiveSettings::plotjuggler},
                                   std::pair{"page", &LiveSettings::page}}) {
    if (live.has(key)) {
      endpoint(live[key], settings.*value);
    }
  }
  if (live.has("valid")) {
    log::read_validity(live["valid"], settings.valid);
  }
  if (live.has("parameters")) {
    settings.parameters = read_parameters(live["parameters"]);
  }
  text("token", settings.token);
  if (live.has("token") && !is_good_token(settings.token)) {
    live["token"].refuse("has to be 16 to 128 letters, digits, '-' and '_'");
  }
  return settings;
}

// Samples per signal: the window of a pose is longer than that of a derivative.
std::size_t history_of(const StreamPlan& plan) {
  const double window_s = plan.pose ? 2.0 * plan.pose->half_s + plan.gap_s + plan.wait_s : 0.0;
  return std::max(kTuning.history,
                  static_cast<std::size_t>(std::min(window_s * kTuning.pose_rate_hz,
                                                    static_cast<double>(kTuning.most_history))));
}

StreamPlan plan_of(const log::LogConfig& config) {
  if (!config.makes_samples()) {
    throw InputError({.file = config.source, .line = 0, .field = "log"},
                     "names no topics; it takes [log.states] and [log.commands], as in u = "
                     "\"/odom:twist.twist.linear.x\"");
  }
  if (!config.roles.time.empty()) {
    throw InputError({.file = config.source, .line = 0, .field = "log.time"},
                     "belongs to CSV files; messages have times of their own");
  }
  return in_file(config.source, [&] {
    StreamPlan plan = log::stream_plan(config, config.roles);
    for (StreamPlan::Source& source : plan.sources) {
      source.keep = history_of(plan);
      try {
        bag::parse_column(source.from);
      } catch (const InputError& error) {
        config.refuse_column(source.from, error.what());
      }
    }
    const SampleStream has_the_checks(plan);
    return plan;
  });
}

std::string names_of(const std::array<std::string, 3>& columns) {
  return fmt::format("{},{},{}", columns[0], columns[1], columns[2]);
}

// With conversions of units.
std::string scale_text(const StreamPlan::Source& source) {
  return number_text(source.scale) +
         (source.about == 0.0 ? "" : " about " + number_text(source.about));
}

// Dead reckoning has a heading, and a current, in the plane alone.
void check_heading(const file::TomlNode& heading, const Configuration& configuration) {
  const StreamPlan& plan = configuration.plan;
  const std::string& name = configuration.live.heading;
  std::vector<std::string> names;
  std::ranges::transform(plan.sources, std::back_inserter(names), &StreamPlan::Source::name);
  if (std::ranges::find(names, name) == names.end()) {
    heading.refuse("'" + name + "' is no signal of [log.states] or [log.commands]" +
                   did_you_mean(name, names));
  }
  const std::map<std::string, Unit> units = configuration.units();
  if (const auto unit = units.find(name);
      unit != units.end() && unit->second != Unit::named("rad")) {
    heading.refuse("'" + name + "' is in " + unit->second.text() + "; a heading is an angle");
  }
  constexpr std::array<std::size_t, 3> kPlane{0, 1, 5};  // surge, sway, yaw rate
  const std::vector<std::size_t> states =
      find_states(configuration.settings.shared.states, plan.inputs, plan.targets.size());
  for (std::size_t i = 0; i < kPlane.size(); ++i) {
    if (i >= states.size() || velocity_axis(plan.inputs[states[i]]) != kPlane[i]) {
      heading.refuse(
          "is used for vehicles in the plane, whose first three velocities are surge, sway and yaw "
          "rate; with other axes a current is not estimated: leave the key out");
    }
  }
}

Configuration configuration_of(const file::TomlNode& root, const std::string& file,
                               log::LogConfig log, const std::vector<std::string>& set) {
  Configuration configuration{
      .file = file, .log = std::move(log), .plan = {}, .settings = {}, .live = {}};
  configuration.plan = plan_of(configuration.log);
  configuration.settings = format::make_settings(format::read_settings_file(root), set,
                                                 configuration.plan.targets.size());
  if (root.has("live")) {
    configuration.live = read_live(root["live"]);
    if (!configuration.live.heading.empty()) {
      check_heading(root["live"]["heading"], configuration);
    }
  }
  configuration.live.valid.insert(configuration.log.valid.begin(), configuration.log.valid.end());
  return configuration;
}

}  // namespace

Endpoint parse_endpoint(const std::string& text, const std::string& field) {
  const std::size_t colon = text.rfind(':');
  Endpoint endpoint{.host = colon == std::string::npos ? "127.0.0.1" : text.substr(0, colon)};
  double port = 0.0;
  const bool is_number =
      parse_number(colon == std::string::npos ? text : text.substr(colon + 1), port);
  if (!is_number || endpoint.host.empty() || port != std::trunc(port) || !(port >= 1.0) ||
      port > std::numeric_limits<std::uint16_t>::max()) {
    throw InputError(field, "'" + text + "' has to be a port, or host:port, as in 127.0.0.1:9870");
  }
  endpoint.host = without_brackets(endpoint.host);
  endpoint.port = static_cast<std::uint16_t>(port);
  return endpoint;
}

Fields Configuration::identity() const {
  Fields fields{
      {"log.inputs", join_text(plan.inputs, ", ")},
      {"log.targets", join_text(plan.targets, ", ")},
      {"log.rate", number_text(plan.rate_hz)},
      {"log.clock", log.clock == bag::Clock::header ? "header" : "receive"},
      {"log.mirror_motors", log.mirror_motors ? "true" : "false"},
      {"log.armed_only", log.armed_only ? "true" : "false"},
      {"log.gap", number_text(plan.gap_s)},
      {"log.filter", plan.derivative.window == FilterWindow::causal ? "causal" : "centred"},
      {"log.window", number_text(plan.derivative.window_s)},
      {"log.degree", std::to_string(plan.derivative.degree)},
      {"live.align", live.align},
      {"live.frozen", live.frozen == Frozen::skip ? "skip" : "learn"}};
  for (const auto& [command, known] : log.roles.actuators) {
    fields.emplace_back("log.actuators." + command,
                        fmt::format("neutral {}, dead_band {}, astern {}", known.neutral,
                                    known.dead_band, known.astern));
  }
  for (const StreamPlan::Source& source : plan.sources) {
    const char* const table =
        source.between == Interpolation::line ? "log.states." : "log.commands.";
    fields.emplace_back(table + source.name, source.from);
    fields.emplace_back("log.lag." + source.name, number_text(source.lag_s.value_or(0.0)));
    fields.emplace_back("log.scale." + source.name, scale_text(source));
  }
  for (const StreamPlan::Derived& derived : plan.derived) {
    fields.emplace_back("log.derived." + derived.name, "d(" + derived.of + ")");
  }
  std::string vectors;
  std::string attitudes;
  for (const StreamPlan::Vector& vector : plan.vectors) {
    vectors += fmt::format("{} from {} to {};", names_of(vector.columns), frame_name(vector.from),
                           frame_name(vector.to));
    attitudes += vector.attitude.empty() ? ""
                                         : fmt::format("{} in {};", join_text(vector.attitude, ","),
                                                       vector.is_in_degrees ? "deg" : "rad");
  }
  fields.emplace_back("log.vectors", vectors);
  fields.emplace_back("log.vectors.attitude", attitudes);
  std::string arm;
  if (plan.lever_arm) {
    arm = fmt::format("{} by {} at {}, {}, {} m", names_of(plan.lever_arm->velocity),
                      names_of(plan.lever_arm->rates), plan.lever_arm->arm_m[0],
                      plan.lever_arm->arm_m[1], plan.lever_arm->arm_m[2]);
  }
  fields.emplace_back("log.lever_arm", arm);
  if (plan.pose) {
    fields.emplace_back("log.pose", join_text(plan.pose->sources(), ", "));
    fields.back().second += fmt::format(" over {} s", number_text(2.0 * plan.pose->half_s));
  }
  for (const auto& [column, unit] : rows ? rows->units : std::map<std::string, Unit>{}) {
    fields.emplace_back("log.units." + column, unit.text());
  }
  for (const auto& [column, least] : live.valid) {
    fields.emplace_back("live.valid." + column, number_text(least));
  }
  return fields;
}

std::map<std::string, Unit> Configuration::units() const {
  if (rows) {
    return rows->units;
  }
  std::map<std::string, Unit> units;
  for (const auto& [column, unit] : log::row_units(plan, log.roles)) {
    units.emplace(column, log::si_unit(file, column, unit).first);
  }
  return units;
}

std::vector<std::string> Configuration::columns() const {
  std::vector<std::string> columns;
  for (const StreamPlan::Source& source : plan.sources) {
    if (std::ranges::find(columns, source.from) == columns.end()) {
      columns.push_back(source.from);
    }
  }
  for (const auto& [column, least] : live.valid) {
    if (std::ranges::find(columns, column) == columns.end()) {
      columns.push_back(column);
    }
  }
  return columns;
}

Configuration read_configuration(const std::filesystem::path& file,
                                 const std::vector<std::string>& set) {
  return read_configuration(file::TomlNode::read(file), file.string(), set);
}

Configuration read_configuration(const file::TomlNode& root, const std::string& name,
                                 const std::vector<std::string>& set) {
  return configuration_of(root, name, log::read_log_config(root), set);
}

Configuration draft_configuration(const log::LogSource& source, const std::vector<std::string>& set,
                                  std::string& summary) {
  const log::Draft draft = log::draft_of(source);
  if (!draft.is_complete()) {
    throw InputError({.file = source.path, .line = 0, .field = {}}, draft.unclear());
  }
  summary = draft.summary();
  return configuration_of(file::TomlNode::parse("", source.path), source.path, draft.config, set);
}

namespace {

// A rate measured from time steps is off by rounding, and times of rows with it.
double whole_rate(double rate_hz) {
  constexpr double kMicrohertz = 1e6;
  const double rounded = std::round(kMicrohertz * rate_hz) / kMicrohertz;
  return std::abs(rounded - rate_hz) < 1e-9 * rate_hz ? rounded : rate_hz;
}

}  // namespace

Configuration rows_configuration(log::Dataset rows, const std::filesystem::path& file,
                                 const std::vector<std::string>& set) {
  const file::TomlNode root =
      file.empty() ? file::TomlNode::parse("", rows.source) : file::TomlNode::read(file);
  log::LogConfig log;
  log.source = rows.source;
  log.roles = {.inputs = rows.input_names,
               .targets = rows.target_names,
               .rate_hz = whole_rate(rows.rate_hz),
               .actuators = rows.actuators};
  log.plan.sources = RowReader::sources_of(rows);
  log.plan.gap_s = std::max(log.plan.gap_s, kLongestStep / rows.rate_hz);
  Configuration configuration =
      configuration_of(root, file.empty() ? rows.source : file.string(), std::move(log), set);
  configuration.rows = std::make_shared<const log::Dataset>(std::move(rows));
  return configuration;
}

}  // namespace kelpie::live
