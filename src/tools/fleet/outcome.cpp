// SPDX-License-Identifier: Apache-2.0
#include "fleet/outcome.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <numeric>

#include "kelpie/vehicle/diagnosis.hpp"
#include "study/alignment.hpp"
#include "study/diagnosis.hpp"
#include "study/summary.hpp"

namespace kelpie::fleet {
namespace {

using file::Json;
using file::JsonNode;
using file::number;

constexpr double kMostCounted = 9007199254740992.0;  // 2^53: exact in JSON

// Where each measure stands in an axis' JSON.
struct Place {
  Measure measure;
  std::string_view group;
  std::string_view key;
};
constexpr std::array<Place, kMeasures> kPlaces{{
    {Measure::r2_final, "r2", "final"},
    {Measure::r2_mean, "r2", "mean"},
    {Measure::one_step, "r2", "one_step"},
    {Measure::coverage, "intervals", "held"},
    {Measure::least_squares_final, "least_squares", "final"},
    {Measure::least_squares_one_step, "least_squares", "one_step"},
    {Measure::mean_final, "mean", "final"},
    {Measure::mean_one_step, "mean", "one_step"},
    {Measure::last_value_one_step, "last_value", "one_step"},
}};

AxisOutcome axis_outcome(const study::AxisResult& axis) {
  const study::Baselines& sticks = axis.baselines;
  AxisOutcome outcome{
      axis.name,
      axis.unit,
      {axis.r2_final, axis.r2_mean, axis.prequential_r2, axis.coverage.share,
       sticks.least_squares.r2_final, sticks.least_squares.prequential_r2, sticks.mean.r2_final,
       sticks.mean.prequential_r2, sticks.last_value.prequential_r2}};
  for (double& value : outcome.values) {
    value = std::clamp(value, -JsonNode::kLargest, JsonNode::kLargest);
  }
  return outcome;
}

Json axis_json(const AxisOutcome& axis) {
  Json json = {{"name", axis.name}, {"unit", file::text_or_null(axis.unit)}};
  for (const Place& place : kPlaces) {
    json[std::string(place.group)][std::string(place.key)] = number(axis[place.measure]);
  }
  return json;
}

AxisOutcome read_axis(const JsonNode& node) {
  AxisOutcome axis{
      node["name"].text(), node["unit"].json().is_null() ? "" : node["unit"].text(), {}};
  for (const Place& place : kPlaces) {
    axis.values[static_cast<std::size_t>(place.measure)] =
        number_or_none(node[std::string(place.group)][std::string(place.key)]);
  }
  return axis;
}

std::size_t read_count(const JsonNode& node) {
  const double value = node.number();
  node.require(value >= 0.0 && value <= kMostCounted, "is no count");
  return static_cast<std::size_t>(value);
}

// All axes of a model are updated one after the other.
std::vector<double> model_updates_us(const study::StreamResult& stream) {
  std::vector<double> updates = stream.axes.front().update_us;
  for (std::size_t axis = 1; axis < stream.axes.size(); ++axis) {
    std::ranges::transform(updates, stream.axes[axis].update_us, updates.begin(), std::plus{});
  }
  return updates;
}

}  // namespace

Outcome outcome_of(const study::StreamResult& stream, double duration_s) {
  Outcome outcome{.alignment = stream.alignment.why.empty()
                                   ? ""
                                   : study::alignment_text(stream.alignment, stream.rate_hz),
                  .training_rows = stream.training_rows,
                  .held_out_rows = stream.held_out_rows,
                  .duration_s = duration_s,
                  .memory_bytes = stream.memory_bytes,
                  .findings = study::diagnosis_lines(stream),
                  .left = study::left_text(stream),
                  .axes = {},
                  .times = {}};
  std::ranges::transform(stream.axes, std::back_inserter(outcome.axes), axis_outcome);
  const std::vector<double> updates = model_updates_us(stream);
  const study::Quantiles times = study::quantiles_of(updates);
  outcome.times.update_us = times.median;
  outcome.times.p99_us = times.p99;
  if (stream.rate_hz > 0.0) {
    outcome.times.share = 1e-6 * std::reduce(updates.begin(), updates.end()) * stream.rate_hz /
                          static_cast<double>(updates.size());
  }
  return outcome;
}

Json outcome_json(const Outcome& outcome) {
  return {{"seconds", number(outcome.times.seconds)},
          {"times",
           {{"update_us", number(outcome.times.update_us)},
            {"update_us_p99", number(outcome.times.p99_us)},
            {"real_time_share", number(outcome.times.share)}}},
          {"alignment", outcome.alignment},
          {"training_rows", outcome.training_rows},
          {"held_out_rows", outcome.held_out_rows},
          {"duration_s", number(outcome.duration_s)},
          {"memory_bytes", outcome.memory_bytes},
          {"findings", outcome.findings},
          {"left", outcome.left},
          {"axes", file::list(outcome.axes, axis_json)}};
}

Outcome read_outcome(const JsonNode& node) {
  Outcome outcome;
  outcome.alignment = node["alignment"].text();
  outcome.training_rows = read_count(node["training_rows"]);
  outcome.held_out_rows = read_count(node["held_out_rows"]);
  outcome.duration_s = number_or_none(node["duration_s"]);
  outcome.memory_bytes = read_count(node["memory_bytes"]);
  for (const JsonNode& finding : node["findings"].items()) {
    outcome.findings.push_back(finding.text());
  }
  if (node.json().contains("left")) {  // a study of an earlier version has it among the findings
    outcome.left = node["left"].text();
  }
  for (const JsonNode& axis : node["axes"].items()) {
    outcome.axes.push_back(read_axis(axis));
  }
  const JsonNode times = node["times"];
  outcome.times = {number_or_none(node["seconds"]), number_or_none(times["update_us"]),
                   number_or_none(times["update_us_p99"]),
                   number_or_none(times["real_time_share"])};
  return outcome;
}

double number_or_none(const JsonNode& node) {
  return node.json().is_null() ? kNoValue : node.number();
}

}  // namespace kelpie::fleet
