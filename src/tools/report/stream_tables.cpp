// SPDX-License-Identifier: Apache-2.0
#include "report/stream_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "chart/wording.hpp"
#include "core/text.hpp"
#include "report/stream_figures.hpp"
#include "study/terms.hpp"

namespace kelpie::report {
namespace {

constexpr std::string_view kDisturbanceNote =
    "With disturbance: kelpie's prediction and the recent error (docs/method/uncertainty.md). ";
constexpr std::string_view kMemberNote =
    "By how well each foretold what lay ahead, lately. Posterior: terms and kernels. Terms: the "
    "same without kernels. Svr: the paper's learner. Mean: of the targets "
    "(docs/method/posterior.md).";
constexpr std::string_view kCoverageNote =
    "Held: share of the samples inside the interval that was in force before they were learned. "
    "Lowest: in any 500 samples in a row of one configuration, from its 501st on. Widths are in "
    "the target's unit.";
constexpr std::size_t kLongestFormula = 28;
constexpr std::size_t kLongestUnit = 20;
constexpr std::size_t kMostShownTerms = 12;

std::string percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.1f} %", 100.0 * share) : "–";
}

std::string promised(const study::StreamResult& result) {
  const auto found =
      std::ranges::find(result.settings, "coverage", &std::pair<std::string, std::string>::first);
  return found == result.settings.end() ? "" : " (promised: " + found->second + ")";
}

constexpr std::string_view kCoefficientsNote =
    "The terms with the largest effects; all are in result.json. ±: standard error. Change: since "
    "half of the stream. Effect: coefficient times the term's root mean square over "
    "the training rows, in the target's unit. What the kernel explains beside the terms is in none "
    "of these numbers.";

std::string or_dash(const std::string& text) {
  return text.empty() ? "–" : text;
}

// Of the coefficient's size, so that a thruster that loses effect is negative whatever its sign. A
// percentage says something as long as the coefficient was about as large before.
std::string change(double before, double after) {
  const double percent = 100.0 * (after / before - 1.0);
  if (!std::isfinite(percent)) {
    return "–";
  }
  if (before * after < 0.0) {
    return "sign";
  }
  if (std::abs(percent) >= 999.5) {
    return ">999 %";
  }
  const bool none = std::abs(percent) < 0.5;
  return fmt::format("{}{:.0f} %", none ? "±" : percent > 0.0 ? "+" : "−", std::abs(percent));
}

}  // namespace

chart::TextTable baseline_table(const study::StreamResult& result) {
  chart::TextTable table{
      "Beside simple predictors (R²)",
      {"axis", "held out:\nkelpie", "\nleast squares", "\nmean", "one ahead:\nkelpie",
       "\nwith disturbance", "\nleast squares", "\nlast value"},
      {},
      {std::string(kDisturbanceNote) + std::string(kBaselineNote)}};
  for (const study::AxisResult& axis : result.axes) {
    const study::Baselines& beside = axis.baselines;
    table.rows.push_back({name_of(axis), chart::decimal(axis.r2_final),
                          chart::decimal(beside.least_squares.r2_final),
                          chart::decimal(beside.mean.r2_final), chart::decimal(axis.prequential_r2),
                          chart::decimal(axis.corrected_r2),
                          chart::decimal(beside.least_squares.prequential_r2),
                          chart::decimal(beside.last_value.prequential_r2)});
  }
  return table;
}

chart::TextTable member_table(const study::StreamResult& result) {
  chart::TextTable table{"Weights of the members", {"axis"}, {}, {std::string(kMemberNote)}};
  for (const study::AxisResult& axis : result.axes) {
    if (axis.members.empty()) {
      continue;
    }
    std::vector<std::string> row{name_of(axis)};
    for (const MemberShare& member : axis.members) {
      if (table.rows.empty()) {
        table.head.push_back(member.name);
      }
      row.push_back(fmt::format("{:.0f} %", 100.0 * member.share));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

chart::TextTable actuator_table(const AlignmentResult& found) {
  chart::TextTable table{
      "Actuators",
      {"command", "neutral", "dead\nband", "gain\nastern", "lag/s", "rate/s", "delay/s"},
      {},
      {"What stands between a command and its effect, in the unit of the command. Lag: time "
       "constant of the first order. Rate: fastest change per second; –: unlimited."}};
  for (std::size_t k = 0; k < found.alignment.actuators.size(); ++k) {
    const Actuator& actuator = found.alignment.actuators[k];
    std::vector<std::string> row{found.alignment.commands[k]};
    for (const Actuator::Field& field : Actuator::fields()) {
      const double value = actuator.*field.number;
      row.push_back(field.name == "rate" && value == 0.0 ? "–" : short_number(value));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

chart::TextTable coverage_table(const study::StreamResult& result) {
  chart::TextTable table{
      "Intervals one step ahead" + promised(result),
      {"axis", "samples", "held", "lowest", "mean width", "median width", "unit"},
      {},
      {std::string(kCoverageNote)}};
  for (const study::AxisResult& axis : result.axes) {
    const std::string name = name_of(axis);
    for (const auto& [coverage, row] :
         {std::pair(axis.coverage, name),
          std::pair(axis.corrected_coverage, name + " with disturbance")}) {
      if (coverage.samples == 0) {
        continue;
      }
      table.rows.push_back({row, chart::grouped(coverage.samples), percent(coverage.share),
                            percent(coverage.lowest), chart::significant(coverage.mean_width),
                            chart::significant(coverage.median_width),
                            or_dash(chart::safe_text(chart::unit_text(axis.unit)))});
    }
  }
  return table;
}

std::vector<chart::TextTable> coefficient_tables(const study::StreamResult& result) {
  std::vector<chart::TextTable> tables;
  for (const study::AxisResult& axis : result.axes) {
    if (axis.terms.empty()) {
      continue;
    }
    const std::string unit = axis.unit.empty() ? "" : " in " + chart::unit_text(axis.unit);
    chart::TextTable table{
        axis.name + unit, {"term", "coefficient", "±", "unit", "at half", "change", "effect"}, {}};
    for (const study::TermView& view :
         study::most_effective(study::term_views(axis), kMostShownTerms)) {
      table.rows.push_back(
          {chart::shortened(view.term.formula, kLongestFormula), chart::significant(view.value),
           chart::significant(view.term.error),
           chart::shortened(or_dash(chart::unit_text(view.term.unit)), kLongestUnit),
           chart::significant(view.at_half), change(view.at_half, view.value),
           chart::significant(view.effect)});
    }
    tables.push_back(std::move(table));
  }
  if (!tables.empty()) {
    tables.back().notes.emplace_back(kCoefficientsNote);
  }
  return tables;
}

}  // namespace kelpie::report
