// SPDX-License-Identifier: Apache-2.0
#include "log/log_config.hpp"
#include "core/angle.hpp"
#include "log/ardusub.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "file/toml.hpp"
#include "kelpie/core/error.hpp"
#include "log/known_roles.hpp"

namespace kelpie::log {
namespace {

constexpr const char* kColumns = "a list of column names";

// The word's place among `words`.
std::size_t choice(const file::TomlNode& value, const std::vector<std::string>& words) {
  const std::string text = value.text("one of " + join_text(words, ", "));
  const auto found = std::ranges::find(words, text);
  if (found == words.end()) {
    value.refuse(unknown_name(text, "choice", words));
  }
  return static_cast<std::size_t>(found - words.begin());
}

std::array<std::string, 3> three_names(const file::TomlNode& value) {
  const std::string kind = "a list of three columns, x, y and z";
  const std::vector<std::string> names = file::texts_of(value, kind);
  if (names.size() != 3) {
    value.refuse("has to be " + kind);
  }
  return {names[0], names[1], names[2]};
}

Frame frame_of(const file::TomlNode& value) {
  const std::string name = value.text("a frame: FLU, FRD, ENU or NED");
  return file::located(value, [&] { return frame_from(name); });
}

bag::Clock clock_of(const file::TomlNode& value) {
  return choice(value, {"receive", "header"}) == 0 ? bag::Clock::receive : bag::Clock::header;
}

[[noreturn]] void refuse(const LogConfig& config, const std::string& key,
                         const std::string& message) {
  throw InputError({.file = config.source, .field = key}, message);
}

constexpr std::array<const char*, 10> kPoseParts{"x",   "y",  "z",  "roll", "pitch",
                                                 "yaw", "qw", "qx", "qy",   "qz"};

// Sources of a pose by their part.
struct PoseParts {
  std::map<std::string, std::string> names{};
  bool is_in_degrees = false;
};

class LogConfigReader {
 public:
  explicit LogConfigReader(LogConfig& config) : config_(config) {}

  // In the order of the table below: what is derived or late has to be there already.
  void read(const file::TomlNode& log) {
    const std::vector<std::pair<std::string, std::function<void(const TomlNode&)>>> readers{
        {"inputs",
         [&](const TomlNode& value) { roles().inputs = file::texts_of(value, kColumns); }},
        {"targets",
         [&](const TomlNode& value) { roles().targets = file::texts_of(value, kColumns); }},
        {"time", [&](const TomlNode& value) { roles().time = value.text("a column name"); }},
        {"rate",
         [&](const TomlNode& value) {
           roles().rate_hz = value.number("a number of rows per second");
         }},
        {"configuration",
         [&](const TomlNode& value) { roles().configuration = value.text("a column name"); }},
        {"units", [&](const TomlNode& value) { read_units(value); }},
        {"ignore",
         [&](const TomlNode& value) { roles().ignored = file::texts_of(value, kColumns); }},
        {"states", [&](const TomlNode& value) { read_sources(value, Interpolation::line); }},
        {"commands", [&](const TomlNode& value) { read_sources(value, Interpolation::hold); }},
        {"pose", [&](const TomlNode& value) { read_pose(value); }},
        {"scale", [&](const TomlNode& value) { read_scales(value); }},
        {"actuators", [&](const TomlNode& value) { read_actuators(value); }},
        {"derived", [&](const TomlNode& value) { read_derived(value); }},
        {"valid", [&](const TomlNode& value) { read_validity(value, config_.valid); }},
        {"clock", [&](const TomlNode& value) { config_.clock = clock_of(value); }},
        {"armed_only", [&](const TomlNode& value) { config_.armed_only = value.flag(); }},
        {"mirror_motors", [&](const TomlNode& value) { read_mirror(value); }},
        {"messages",
         [&](const TomlNode& value) {
           config_.messages =
               std::filesystem::path(config_.source).parent_path() / value.text("a folder");
         }},
        {"gap", [&](const TomlNode& value) { plan().gap_s = value.number("a number of s"); }},
        {"filter",
         [&](const TomlNode& value) {
           plan().derivative.window = choice(value, {"centred", "causal"}) == 0
                                          ? FilterWindow::centred
                                          : FilterWindow::causal;
         }},
        {"window", [&](const TomlNode& value) { read_window(value); }},
        {"degree",
         [&](const TomlNode& value) {
           plan().derivative.degree = static_cast<int>(value.count());
         }},
        {"lag", [&](const TomlNode& value) { read_lags(value); }},
        {"vectors", [&](const TomlNode& value) { read_vectors(value); }},
        {"lever_arm", [&](const TomlNode& value) { read_lever_arm(value); }},
        {"lag_part", [&](const TomlNode& value) { read_lag_part(value); }}};
    std::vector<std::string> keys;
    std::ranges::transform(readers, std::back_inserter(keys),
                           [](const auto& one) { return one.first; });
    log.table(keys);
    for (const auto& [key, read_value] : readers) {
      if (log.has(key)) {
        read_value(log[key]);
      }
    }
  }

 private:
  using TomlNode = file::TomlNode;

  Roles& roles() { return config_.roles; }
  SamplingPlan& plan() { return config_.plan; }

  void read_units(const file::TomlNode& value) {
    const std::string kind = "a table of units, as in {u = \"m/s\"}";
    for (const file::TomlNode& unit : value.members(kind)) {
      roles().units[unit.key()] = unit.text("a unit, as in \"m/s\"");
    }
  }

  // n1 = {neutral = 1500, dead_band = 25, astern = 0.8}; lag, rate and delay are found.
  void read_actuators(const file::TomlNode& value) {
    for (const file::TomlNode& command :
         value.members("a table of commands, as in {n1 = {neutral = 1500}}")) {
      command.table({"neutral", "dead_band", "astern"});
      KnownActuator& known = roles().actuators[command.key()];
      const auto read = [&](const char* key, double& number, auto is_sound, const char* wanted) {
        if (command.has(key)) {
          number = command[key].number("a number in the unit of the command");
          if (!is_sound(number)) {
            command[key].refuse(wanted);
          }
        }
      };
      read(
          "neutral", known.neutral, [](double v) { return std::isfinite(v); }, "has to be finite");
      read(
          "dead_band", known.dead_band, [](double v) { return v >= 0.0 && std::isfinite(v); },
          "has to be 0 or more");
      read(
          "astern", known.astern, [](double v) { return v > 0.0 && std::isfinite(v); },
          "has to be > 0");
    }
  }

  void read_sources(const file::TomlNode& value, Interpolation between) {
    for (const file::TomlNode& source :
         value.members("a table of columns and where they come from")) {
      plan().sources.push_back(
          {.name = source.key(),
           .from = source.text("a topic and field, as in \"/odom:twist.twist.linear.x\""),
           .between = between});
      config_.places.emplace(plan().sources.back().from, source.place());
    }
  }

  // ["x", "y", "psi"], or {x = "/mocap:position.x", …, angles = "deg"}
  void read_pose(const file::TomlNode& value) {
    PoseParts parts;
    if (value.type() == file::TomlNode::Type::list) {
      for (const std::string& name :
           file::texts_of(value, "a list of columns, as in [\"x\", \"y\", \"yaw\"]")) {
        const std::optional<std::string> part = pose_part_by_name(source_text(name));
        if (!part) {
          value.refuse(
              "'" + name + "' names no part of a pose; write {x = \"" + name + "\"} with one of " +
              join_text(std::vector<std::string>(kPoseParts.begin(), kPoseParts.end()), ", "));
        }
        add_part(value, *part, name, name, parts);
      }
    } else {
      std::vector<std::string> keys(kPoseParts.begin(), kPoseParts.end());
      keys.insert(keys.end(), {"depth", "angles"});
      value.table(keys);
      for (const file::TomlNode& part : value.members()) {
        if (part.key() != "angles") {
          add_part(part, part.key() == "depth" ? "z" : part.key(), part.key(),
                   part.text("a topic and field, or a column"), parts);
        }
      }
      parts.is_in_degrees = value.has("angles") && choice(value["angles"], {"rad", "deg"}) == 1;
    }
    plan().pose = pose_of(value, parts);
  }

  // What the user calls by a short name, in the words of the log.
  std::string source_text(const std::string& name) {
    const auto known = std::ranges::find(plan().sources, name, &SamplingPlan::Source::name);
    return known != plan().sources.end() && !pose_part_by_name(name) ? known->from : name;
  }

  // The source of a part: a state of that name, or a new one called `name`.
  void add_part(const file::TomlNode& at, const std::string& part, const std::string& name,
                const std::string& from, PoseParts& parts) {
    auto source = std::ranges::find(plan().sources, from, &SamplingPlan::Source::name);
    if (source == plan().sources.end()) {
      plan().sources.push_back({.name = name, .from = from});
      config_.places.emplace(from, at.place());
      source = std::prev(plan().sources.end());
    }
    if (!parts.names.emplace(part, source->name).second) {
      at.refuse(part + " of the pose is named twice, by " + parts.names.at(part) + " and " +
                source->name);
    }
  }

  StreamPlan::Pose pose_of(const file::TomlNode& value, const PoseParts& parts) {
    StreamPlan::Pose pose = file::located(value, [&] { return pose_from(parts.names); });
    for (const SamplingPlan::Source& source : plan().sources) {
      if (parts.is_in_degrees && pose.attitude.size() == 3 &&
          std::ranges::count(pose.attitude, source.name) > 0) {
        const auto& [name, unit] = *roles().units.try_emplace(source.name, "deg").first;
        if (si_unit(config_.source, name, unit).second != kRadPerDegree) {
          value["angles"].refuse("says \"deg\", but 'units' says " + name + " = \"" + unit + "\"");
        }
      }
    }
    return pose;
  }

  // Of a pose the whole window, else of derivatives.
  void read_window(const file::TomlNode& value) {
    if (!plan().pose) {
      plan().derivative.window_s = value.number();
    } else if (value.type() == file::TomlNode::Type::text) {
      choice(value, {"auto"});
    } else {
      plan().pose->half_s = 0.5 * value.number("\"auto\" or a number of s");
      if (plan().pose->half_s <= 0.0) {
        value.refuse("has to be more than 0 s");
      }
    }
  }

  // phi = 0.01745, m2 = {by = -1, about = 1500}
  // Behind [log.scale], whose mirrors would be mirrored again.
  void read_mirror(const file::TomlNode& value) {
    config_.mirror_motors = value.flag();
    for (const SamplingPlan::Source& source : plan().sources) {
      if (config_.mirror_motors && source.scale < 0.0 && output_of(source.from) > 0) {
        value.refuse(source.name + " is mirrored by [log.scale] already; leave one of them out");
      }
    }
  }

  void read_scales(const file::TomlNode& value) {
    for (const file::TomlNode& scale :
         value.members("a table of factors, as in {phi = 0.01745, m2 = {by = -1, about = 1500}}")) {
      SamplingPlan::Source& source = require_source(scale, scale.key());
      const bool is_table = scale.type() == file::TomlNode::Type::table;
      if (is_table) {
        scale.table({"by", "about"});
        source.about = scale.has("about") ? scale["about"].number() : 0.0;
      }
      source.scale =
          is_table ? scale["by"].number() : scale.number("a factor, or a table by, about");
      if (!std::isfinite(source.scale) || source.scale == 0.0 || !std::isfinite(source.about)) {
        scale.refuse("has to be finite, and the factor not 0");
      }
    }
  }

  // udot = "d(u)"
  void read_derived(const file::TomlNode& value) {
    for (const file::TomlNode& derived : value.members("a table, as in {udot = \"d(u)\"}")) {
      const std::string kind = "the derivative of a column, as in \"d(u)\"";
      const std::string text = derived.text(kind);
      if (!text.starts_with("d(") || !text.ends_with(')')) {
        derived.refuse("'" + text + "' has to be " + kind);
      }
      const std::string of(trimmed(std::string_view(text).substr(2, text.size() - 3)));
      require_source(derived, of);
      plan().derived.push_back({derived.key(), of});
    }
  }

  SamplingPlan::Source& require_source(const file::TomlNode& user, const std::string& name) {
    const auto found = std::ranges::find(plan().sources, name, &SamplingPlan::Source::name);
    if (found == plan().sources.end()) {
      std::vector<std::string> names;
      std::ranges::transform(plan().sources, std::back_inserter(names),
                             &SamplingPlan::Source::name);
      user.refuse(unknown_name(name, "state or command", names));
    }
    return *found;
  }

  static std::optional<double> lag_of(const file::TomlNode& value) {
    const std::string kind = "\"auto\" or a number of s";
    if (value.type() != file::TomlNode::Type::text) {
      return value.number(kind);
    }
    if (value.text() != "auto") {
      value.refuse("has to be " + kind);
    }
    return std::nullopt;
  }

  void read_lags(const file::TomlNode& value) {
    if (value.type() == file::TomlNode::Type::table) {
      for (const file::TomlNode& lag : value.members()) {
        require_source(lag, lag.key()).lag_s = lag_of(lag);
      }
      return;
    }
    for (SamplingPlan::Source& source : plan().sources) {
      if (source.between == Interpolation::hold) {
        source.lag_s = lag_of(value);
      }
    }
  }

  void read_lag_part(const file::TomlNode& value) {
    plan().lag_part = value.number();
    if (const double part = plan().lag_part; std::isnan(part) || part <= 0.0 || part > 1.0) {
      value.refuse("is out of range; it has to be more than 0, up to 1");
    }
  }

  // [{columns = ["u", "v", "w"], from = "FLU", to = "FRD"}]
  void read_vectors(const file::TomlNode& value) {
    for (const file::TomlNode& vector :
         value.tables({"columns", "from", "to", "attitude", "angles"})) {
      plan().vectors.push_back({.columns = three_names(vector["columns"]),
                                .from = frame_of(vector["from"]),
                                .to = frame_of(vector["to"])});
      if (vector.has("attitude")) {
        plan().vectors.back().attitude = file::texts_of(
            vector["attitude"], "a list of roll, pitch and yaw, or of a quaternion w, x, y, z");
      }
      plan().vectors.back().is_in_degrees =
          vector.has("angles") && choice(vector["angles"], {"rad", "deg"}) == 1;
    }
  }

  // {velocity = ["u", "v", "w"], rates = ["p", "q", "r"], arm = [0.3, 0.0, -0.1]}
  void read_lever_arm(const file::TomlNode& value) {
    if (plan().pose) {
      value.refuse("moves velocities to another point; with 'pose' give the pose of that point");
    }
    value.table({"velocity", "rates", "arm"});
    SamplingPlan::LeverArm lever{.velocity = three_names(value["velocity"]),
                                 .rates = three_names(value["rates"])};
    file::read_numbers(value["arm"], lever.arm_m);
    plan().lever_arm = lever;
  }

  LogConfig& config_;
};

// Before any log is read. A rate may still come from the command line.
void check_plan(const file::TomlNode& log, const LogConfig& config) {
  SamplingPlan plan = config.plan;
  plan.rate_hz = log.has("rate") ? config.roles.rate_hz : 1.0;
  log.locate_errors([&] { plan.validate(); });
}

}  // namespace

void LogConfig::refuse_column(const std::string& column, const std::string& why) const {
  const auto known = places.find(column);
  throw InputError(known == places.end() ? Place{.file = source, .field = "log"} : known->second,
                   why);
}

void read_validity(const file::TomlNode& table, std::map<std::string, double>& valid) {
  for (const file::TomlNode& value :
       table.members("a table of fields, as in {\"/dvl:velocity_valid\" = 1}")) {
    file::located(value, [&] { bag::parse_column(value.key()); });
    valid[value.key()] = value.number("the least value of a valid message, a number");
  }
}

StreamPlan::Pose pose_from(const std::map<std::string, std::string>& sources) {
  const auto names_of = [&](const std::vector<const char*>& parts) {
    std::vector<std::string> names;
    for (const char* const part : parts) {
      names.push_back(sources.contains(part) ? sources.at(part) : "");
    }
    return names;
  };
  const std::vector<std::string> position = names_of({"x", "y", "z"});
  const std::vector<std::string> angles = names_of({"roll", "pitch", "yaw"});
  const std::vector<std::string> quaternion = names_of({"qw", "qx", "qy", "qz"});
  const auto is_any = [](const std::vector<std::string>& names) {
    return std::ranges::any_of(names, [](const auto& name) { return !name.empty(); });
  };
  if (is_any(angles) && is_any(quaternion)) {
    throw InputError("has angles and a quaternion; one of them is the attitude");
  }
  StreamPlan::Pose pose{.position = {position[0], position[1], position[2]}};
  pose.attitude = is_any(quaternion) ? quaternion : is_any(angles) ? angles : pose.attitude;
  return pose;
}

void add_pose_targets(const StreamPlan::Pose& pose, Roles& roles) {
  if (roles.targets.empty()) {
    roles.targets = pose.accelerations();
    std::erase_if(roles.targets,
                  [](const std::string& name) { return name == "pdot" || name == "qdot"; });
  }
}

LogConfig read_log_config(const std::filesystem::path& file) {
  return file.empty() ? LogConfig{} : read_log_config(file::TomlNode::read(file));
}

LogConfig read_log_config(const file::TomlNode& root) {
  for (const file::TomlNode& member : root.members()) {
    if (member.type() == file::TomlNode::Type::table && member.key() != "log" &&
        member.key() != "live") {
      member.refuse("unknown table" +
                    did_you_mean(member.key(), std::array<std::string, 2>{"log", "live"}) +
                    "; there are [log] and [live]");
    }
  }
  LogConfig config;
  config.source = root.place().file;
  if (root.has("log")) {
    LogConfigReader(config).read(root["log"]);
    check_plan(root["log"], config);
  }
  return config;
}

namespace {

// The unit is of what [log.scale] gives, so factor (about + scale (v − about)) in the same form.
void convert(const LogConfig& config, double factor, StreamPlan::Source& source) {
  const double scale = factor * source.scale;
  if (source.about != 0.0 && factor != 1.0) {
    if (scale == 1.0) {
      refuse(config, "log.scale." + source.name,
             "and the unit together move values by a constant; leave one of them out");
    }
    source.about *= factor * (1.0 - source.scale) / (1.0 - scale);
  }
  source.scale = scale;
}

// Sources are converted to the SI, so angles of a converted attitude are in rad. A derivative has
// the unit of its source, whatever is said of the derivative.
void convert_sources(const LogConfig& config, const Roles& roles, SamplingPlan& plan) {
  std::map<std::string, std::string> units = config.roles.units;
  for (const auto& [name, unit] : roles.units) {
    units[name] = unit;
  }
  std::vector<std::string> converted;
  for (StreamPlan::Source& source : plan.sources) {
    if (const auto unit = units.find(source.name); unit != units.end()) {
      const double factor = si_unit(config.source, source.name, unit->second).second;
      convert(config, factor, source);
      converted.insert(converted.end(), factor != 1.0 ? 1 : 0, source.name);
    }
  }
  for (StreamPlan::Vector& vector : plan.vectors) {
    vector.is_in_degrees =
        vector.is_in_degrees && std::ranges::none_of(vector.attitude, [&](const auto& angle) {
          return std::ranges::count(converted, angle) > 0;
        });
  }
}

}  // namespace

namespace {

// p and q are columns where somebody names them.
void use_tilt_rates(const Roles& roles, StreamPlan::Pose& pose) {
  for (const auto* const names : {&roles.inputs, &roles.targets, &roles.also}) {
    for (const char* const rate : {"p", "q", "pdot", "qdot"}) {
      pose.has_tilt_rates = pose.has_tilt_rates || std::ranges::count(*names, rate) > 0;
    }
  }
}

}  // namespace

SamplingPlan sampling_plan(const LogConfig& config, const Roles& roles) {
  SamplingPlan plan = config.plan;
  convert_sources(config, roles, plan);
  for (StreamPlan::Source& source : plan.sources) {
    if (roles.has_curves && source.between == Interpolation::line) {
      source.between = Interpolation::curve;
    }
  }
  plan.rate_hz = roles.rate_hz != 0.0 ? roles.rate_hz : config.roles.rate_hz;
  if (plan.rate_hz == 0.0) {
    refuse(config, "log.rate", "is missing; at how many rows per second is the log taken?");
  }
  // Lags go by the targets; where none are named, by the derivatives.
  plan.responses = roles.targets;
  if (plan.pose) {
    use_tilt_rates(roles, *plan.pose);
    plan.responses = roles.targets.empty() ? plan.pose->accelerations() : roles.targets;
  }
  for (const StreamPlan::Derived& derived : plan.derived) {
    if (roles.targets.empty()) {
      plan.responses.push_back(derived.name);
    }
  }
  return plan;
}

StreamPlan stream_plan(const LogConfig& config, const Roles& roles) {
  StreamPlan plan = sampling_plan(config, roles);
  Table columns;
  columns.source = config.source;
  columns.names = {"t"};
  for (const StreamPlan::Source& source : plan.sources) {
    if (!source.lag_s) {
      refuse(config, "log.lag." + source.name,
             "\"auto\" takes a whole log; give the lag in s, as `kelpie convert` finds it");
    }
  }
  if (plan.pose && plan.pose->half_s == 0.0) {
    refuse(config, "log.window",
           "of a pose takes a whole log; give the window in s, as `kelpie learn` finds it");
  }
  Roles known = roles;
  if (plan.pose) {
    add_pose_targets(*plan.pose, known);
  }
  const std::vector<std::string> sampled = sampled_columns(plan);
  columns.names.insert(columns.names.end(), sampled.begin(), sampled.end());
  const Roles parts = guess_roles(columns, known);
  plan.inputs = parts.inputs;
  plan.targets = parts.targets;
  return plan;
}

}  // namespace kelpie::log
