// SPDX-License-Identifier: Apache-2.0
#include "web/events.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <string_view>
#include <vector>

#include "chart/wording.hpp"
#include "file/json.hpp"
#include "kelpie/core/error.hpp"
#include "report/sampling_table.hpp"
#include "study/terms.hpp"

namespace kelpie::web {
namespace {

using file::Json;

constexpr double kShownS = 300.0;  // a figure's window
constexpr const char* kRetryMs = "retry: 2000\n";

Json text(const std::string& words) {
  return chart::printable(words);
}

// Infinite is as good as none.
Json whole(std::size_t count) {
  return static_cast<std::int64_t>(count);
}

std::string event(const char* name, const Json& data) {
  return fmt::format("event: {}\ndata: {}\n\n", name, data.dump());
}

log::Dataset names_of(const live::Configuration& configuration) {
  log::Dataset names;
  names.input_names = configuration.plan.inputs;
  names.target_names = configuration.plan.targets;
  for (const auto& [column, unit] : configuration.log.roles.units) {
    names.units.emplace(column, Unit::parse(unit));
  }
  return names;
}

Json plan_json(const live::Configuration& configuration) {
  const log::Dataset names = names_of(configuration);
  return {{"axes",
           file::list(
               configuration.plan.targets,
               [&](const std::string& axis) {
                 return Json{{"name", text(axis)}, {"unit", text(study::unit_text(names, axis))}};
               })},
          {"window_s", kShownS},
          {"gap_s", configuration.plan.gap_s}};
}

// Six digits of each: more than a screen has pixels.
void append_samples(std::string& out, const std::vector<double>& rows, std::size_t row_size) {
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "event: samples\ndata: [");
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
  out += "]]\n\n";
}

Json coefficient_json(const Coefficient& coefficient, const std::string& axis,
                      const log::Dataset& names) {
  return {{"term", text(coefficient.term)},
          {"value", file::number(coefficient.value)},
          {"error", file::number(coefficient.error)},
          {"unit", text(study::coefficient_unit(coefficient.term, names, axis))}};
}

Json axis_json(const live::AxisHealth& axis, const log::Dataset& names) {
  return {{"name", text(axis.name)},
          {"ready", axis.status.ready},
          {"buffer", axis.status.buffer},
          {"judged", whole(axis.judged)},
          {"r2", file::numbers({axis.r2, axis.r2_least_squares, axis.r2_mean, axis.r2_last_value})},
          {"coverage", file::number(axis.coverage)},
          {"disturbance", file::number(axis.disturbance)},
          {"changes", axis.status.tally.changes},
          {"coefficients", file::list(axis.coefficients, [&](const Coefficient& coefficient) {
             return coefficient_json(coefficient, axis.name, names);
           })}};
}

Json source_json(const live::SourceHealth& source) {
  return {{"name", text(source.name)},
          {"from", text(source.from)},
          {"rate_hz", file::number(source.rate_hz)},
          {"silent_s", file::number(source.silent_s)},
          {"stuck", source.is_stuck},
          {"samples", whole(source.faults.samples)},
          {"found", text(report::faults_text(source.faults))}};
}

Json topic_json(const live::TopicHealth& topic) {
  return {{"name", text(topic.name)},
          {"messages", whole(topic.messages)},
          {"undecodable", whole(topic.undecodable)},
          {"refused", text(topic.refused)},
          {"error", text(topic.last_error)}};
}

Json health_json(const live::Health& health, const live::Configuration& configuration) {
  const log::Dataset names = names_of(configuration);
  const live::LearnerHealth& learner = health.learner;
  return {
      {"t", file::number(learner.last_t_s)},
      {"frozen", learner.is_paused},
      {"learned", whole(learner.learned)},
      {"rows", whole(health.rows)},
      {"incomplete", whole(health.rows_incomplete)},
      {"dropped", whole(health.rows_dropped)},
      {"waiting", whole(health.rows_waiting)},
      {"stuck", whole(learner.frozen)},
      {"vehicle", text(learner.vehicle)},
      {"paused", whole(learner.paused)},
      {"idle_s", file::number(health.idle_s)},
      {"clock_restarts", whole(health.clock_restarts)},
      {"delay_ms", file::numbers({learner.median_delay_ms, learner.longest_delay_ms})},
      {"shift_s", file::number(learner.alignment.lag_s)},
      {"checkpoints", whole(learner.checkpoints)},
      {"checkpoint_t", file::number(learner.checkpoint_t_s)},
      {"checkpoint_error", text(learner.checkpoint_error)},
      {"record_error", text(health.record_error)},
      {"axes", file::list(learner.axes,
                          [&](const live::AxisHealth& axis) { return axis_json(axis, names); })},
      {"signals", file::list(health.sources, source_json)},
      {"topics", file::list(health.topics, topic_json)}};
}

}  // namespace

std::string EventStream::next() {
  std::string out;
  if (!has_begun_) {
    has_begun_ = true;
    out += kRetryMs + event("plan", plan_json(configuration_));
  }
  if (const std::vector<double> rows = feed_.rows(next_row_); !rows.empty()) {
    append_samples(out, rows, feed_.row_size());
  }
  if (const std::vector<Line> lines = feed_.lines(next_line_); !lines.empty()) {
    out += event("said", file::list(lines, [](const Line& line) {
                   return Json::array({line.at_ms, line.text});
                 }));
  }
  if (std::shared_ptr<const live::Health> health = feed_.health(); health && health != health_) {
    health_ = std::move(health);
    out += event("health", health_json(*health_, configuration_));
  }
  return out;
}

}  // namespace kelpie::web
