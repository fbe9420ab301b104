// SPDX-License-Identifier: Apache-2.0
#include "web/events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <vector>

#include "chart/wording.hpp"
#include "core/text.hpp"
#include "file/json.hpp"
#include "kelpie/core/error.hpp"
#include "live/health_table.hpp"
#include "report/sampling_table.hpp"
#include "study/terms.hpp"
#include "web/tuning.hpp"

namespace kelpie::web {
namespace {

using file::Json;

constexpr const char* kRetryMs = "retry: 2000\n";
constexpr std::array kKinds{"count", "gauge", "share", "flag", "text"};  // of HealthKind
constexpr std::array kLevels{"ok", "warn", "error"};                     // of AlertLevel

Json text(const std::string& words) {
  return chart::safe_text(words);
}

std::string event(const char* name, const Json& data) {
  return fmt::format("event: {}\ndata: {}\n\n", name, data.dump());
}

log::Dataset names_of(const live::Configuration& configuration) {
  log::Dataset names;
  names.input_names = configuration.plan.inputs;
  names.target_names = configuration.plan.targets;
  names.units = configuration.units();
  return names;
}

// What the page's tables show, in their order: fields of one key are an array.
template <typename Of>
Json fields_plan() {
  Json fields = Json::array();
  std::string_view before;
  std::size_t place = 0;
  for (const live::HealthField<Of>& field : live::health_fields<Of>()) {
    place = field.key == before ? place + 1 : 0;
    before = field.key;
    if (!field.key.empty() && !field.label.empty()) {
      fields.push_back({{"key", field.key},
                        {"place", place},
                        {"label", field.label},
                        {"help", field.help},
                        {"kind", kKinds[static_cast<std::size_t>(field.kind)]}});
    }
  }
  return fields;
}

// The topics of the signals, the first of many.
std::string source_text(const live::Configuration& configuration) {
  std::vector<std::string> topics;
  for (const StreamPlan::Source& source : configuration.plan.sources) {
    const std::string topic = source.from.substr(0, source.from.find(':'));
    if (!topic.empty() && std::ranges::find(topics, topic) == topics.end()) {
      topics.push_back(topic);
    }
  }
  const std::size_t more = topics.size() > kTuning.topics ? topics.size() - kTuning.topics : 0;
  topics.resize(topics.size() - more);
  return join_text(topics, ", ") + (more == 0 ? "" : fmt::format(" and {} more", more));
}

Json plan_json(const live::Configuration& configuration) {
  const log::Dataset names = names_of(configuration);
  return {
      {"axes", file::list(configuration.plan.targets,
                          [&](const std::string& axis) {
                            return Json{
                                {"name", text(axis)},
                                {"unit", text(chart::unit_text(study::unit_text(names, axis)))}};
                          })},
      {"source", text(source_text(configuration))},
      {"window_s", kTuning.window_s},
      {"gap_s", configuration.plan.gap_s},
      {"fields",
       {{"run", fields_plan<live::Health>()},
        {"axes", fields_plan<live::AxisHealth>()},
        {"signals", fields_plan<live::SourceHealth>()},
        {"thrusters", fields_plan<live::ThrusterHealth>()},
        {"velocities", fields_plan<live::VelocityHealth>()},
        {"parameters", fields_plan<live::ParameterHealth>()}}}};
}

// Six digits of each: more than a screen has pixels.
void append_samples(std::string& out, const std::vector<double>& rows, std::size_t row_size) {
  const auto to = std::back_inserter(out);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool is_first = i % row_size == 0;
    if (is_first) {
      fmt::format_to(to, "{}[{:.3f}", i == 0 ? "" : "],", rows[i]);
    } else if (std::isfinite(rows[i])) {
      fmt::format_to(to, ",{:.6g}", rows[i]);
    } else {
      out += ",null";
    }
  }
  out += ']';
}

Json coefficient_json(const Coefficient& coefficient, const std::string& axis,
                      const log::Dataset& names) {
  return {{"term", text(coefficient.term)},
          {"value", file::number(coefficient.value)},
          {"error", file::number(coefficient.error)},
          {"unit", text(chart::unit_text(study::coefficient_unit(coefficient.term, names, axis)))}};
}

template <typename Of>
Json field_json(const live::HealthField<Of>& field, const Of& of) {
  if (field.get.text != nullptr) {
    return text(field.get.text(of));
  }
  const double value = field.get.number(of);
  switch (field.kind) {
    case live::HealthKind::flag:
      return value > 0.0;
    case live::HealthKind::count:
      return std::isfinite(value) ? Json(static_cast<std::int64_t>(value)) : Json();
    default:  // milliseconds are enough of a time
      return file::number(field.unit == "s" ? std::round(1e3 * value) / 1e3 : value);
  }
}

// All fields with a key; those that share one as an array.
template <typename Of>
void add_fields(Json& json, const Of& of) {
  std::string_view before;
  for (const live::HealthField<Of>& field : live::health_fields<Of>()) {
    if (field.key.empty()) {
      continue;
    }
    const Json value = field_json(field, of);
    Json& there = json[std::string(field.key)];
    if (field.key != before) {
      there = value;
    } else if (there.is_array()) {
      there.push_back(value);
    } else {
      there = Json::array({there, value});
    }
    before = field.key;
    if (!field.names.old_key.empty()) {
      json[std::string(field.names.old_key)] = value;
    }
  }
}

template <typename Of>
Json named_json(const Of& of) {
  Json json{{"name", text(of.name)}};
  add_fields(json, of);
  return json;
}

Json axis_json(const live::AxisHealth& axis, const log::Dataset& names) {
  Json json = named_json(axis);
  json["coefficients"] = file::list(axis.coefficients, [&](const Coefficient& coefficient) {
    return coefficient_json(coefficient, axis.name, names);
  });
  return json;
}

Json source_json(const live::SourceHealth& source) {
  Json json = named_json(source);
  json["from"] = text(source.from);
  json["found"] = text(report::faults_text(source.faults));
  return json;
}

Json alert_json(const live::Alert& alert) {
  return {{"key", alert.key},
          {"level", kLevels[static_cast<std::size_t>(alert.level)]},
          {"subject", text(alert.subject)},
          {"text", text(alert.text)}};
}

Json health_json(const live::Health& health, const live::Health& before,
                 const live::Configuration& configuration) {
  const log::Dataset names = names_of(configuration);
  const live::LearnerHealth& learner = health.learner;
  Json json = Json::object();
  add_fields(json, health);
  json["alerts"] = file::list(live::alerts_of(health, before), alert_json);
  json["axes"] = file::list(learner.axes,
                            [&](const live::AxisHealth& axis) { return axis_json(axis, names); });
  json["signals"] = file::list(health.sources, source_json);
  json["topics"] = file::list(health.topics, named_json<live::TopicHealth>);
  json["thrusters"] = file::list(learner.thrusters, named_json<live::ThrusterHealth>);
  json["velocities"] = file::list(health.reckoning.velocities, named_json<live::VelocityHealth>);
  json["parameters"] = file::list(learner.parameters, named_json<live::ParameterHealth>);
  return json;
}

}  // namespace

std::string EventStream::next() {
  std::string out;
  if (!has_begun_) {
    has_begun_ = true;
    out += kRetryMs + event("plan", plan_json(configuration_));
  }
  std::size_t samples = 0;
  while (samples < kTuning.text_rows) {
    const std::vector<double> rows = feed_.rows(next_row_);
    if (rows.empty()) {
      break;
    }
    out += samples == 0 ? "event: samples\ndata: [" : ",";
    append_samples(out, rows, feed_.row_size());
    samples += rows.size() / feed_.row_size();
  }
  out += samples == 0 ? "" : "]\n\n";
  if (const std::vector<Line> lines = feed_.lines(next_line_); !lines.empty()) {
    out += event("said", file::list(lines, [](const Line& line) {
                   return Json::array({line.at_ms, line.text});
                 }));
  }
  if (std::shared_ptr<const live::Health> health = feed_.health(); health && health != health_) {
    const std::shared_ptr<const live::Health> before = health_ ? health_ : health;
    health_ = std::move(health);
    out += event("health", health_json(*health_, *before, configuration_));
  }
  if (samples == 0 && feed_.has_ended() && !has_said_end_) {
    has_said_end_ = true;
    out += event("end", Json::object());
  }
  return out;
}

}  // namespace kelpie::web
