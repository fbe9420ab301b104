// SPDX-License-Identifier: Apache-2.0
#include "fleet/tuning.hpp"
#include "report/study_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ranges>
#include <utility>

#include "chart/wording.hpp"
#include "core/text.hpp"
#include "file/content.hpp"

namespace kelpie::report {
namespace {

using fleet::AxisSummary;
using fleet::Spread;
using fleet::VehicleSummary;

constexpr std::size_t kMostListed = 50;
constexpr std::size_t kMostNamed = 3;  // vehicles in a headline

std::string in_lines(const std::string& name) {
  return join_text(split_text(name, ' '), "\n");
}

std::string percent_of(std::size_t part, std::size_t whole) {
  return whole == 0 ? "–"
                    : fmt::format("{:.0f} %",
                                  100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

std::string real_time(double share) {
  return std::isfinite(share) ? fmt::format("{:.3g} %", 100.0 * share) : "–";
}

std::string memory_text(const Spread& bytes) {
  return bytes.runs == 0 ? "–" : file::megabytes(static_cast<std::size_t>(bytes.median));
}

std::string counted(std::size_t count, const std::string& what, const std::string& plural = "s") {
  return chart::grouped(count) + " " + what + (count == 1 ? "" : plural);
}

std::string cell_name(const std::string& text) {
  return chart::shortened(text, chart::kLongestName);
}

// The log, and the split where there are several.
std::string run_text(const StudyView& study, std::size_t combination) {
  const fleet::Plan& plan = study.results.plan();
  const fleet::Combination one = study.results.combinations()[combination];
  const std::string& log = study.results.missions()[one.mission].log;
  const fleet::SplitOptions& split = plan.splits[one.split];
  return plan.splits.size() == 1 ? log : fmt::format("{} ({} {})", log, split.split, split.seed);
}

const fleet::Mission& mission_at(const StudyView& study, std::size_t combination) {
  return study.results.missions()[study.results.combinations()[combination].mission];
}

using AxisOfVehicle = std::pair<const VehicleSummary*, const AxisSummary*>;

std::vector<AxisOfVehicle> all_axes(const StudyView& study) {
  std::vector<AxisOfVehicle> axes;
  for (const VehicleSummary& vehicle : study.summary.vehicles) {
    for (const AxisSummary& axis : vehicle.axes) {
      axes.emplace_back(&vehicle, &axis);
    }
  }
  return axes;
}

// Says so where a table has no more than its first rows.
void cut(chart::TextTable& table, std::size_t all, const std::string& which) {
  if (all > table.rows.size()) {
    table.notes.push_back(fmt::format("{} of {}: {}. study.json has all.", table.rows.size(),
                                      chart::grouped(all), which));
  }
}

}  // namespace

std::vector<std::string> study_sentences(const StudyView& study) {
  const fleet::StudySummary& summary = study.summary;
  const std::vector<fleet::LearnerConfig>& learners = study.results.plan().learners;
  double hours = 0.0;
  for (const VehicleSummary& vehicle : summary.vehicles) {
    hours += vehicle.hours;
  }
  const std::size_t failed = study.results.failures().size();
  std::vector<std::string> sentences{fmt::format(
      "{} of {}, {:.3g} h of logs, learned by {} with {}: {}{}.",
      counted(study.results.missions().size(), "mission"),
      counted(summary.vehicles.size(), "vehicle"), hours, counted(learners.size(), "learner"),
      counted(study.results.plan().splits.size(), "split"),
      counted(study.results.combinations().size(), "run"),
      failed == 0 ? "" : fmt::format(", of which {} failed", chart::grouped(failed)))};
  const auto best = std::ranges::max_element(summary.learners, {}, &fleet::LearnerOverall::best);
  if (best != summary.learners.end() && best->judged > 0) {
    sentences.push_back(fmt::format(
        "{}: within {} of the best R² on held-out rows in {} of its runs' axes{}; better than "
        "least squares in {}, worse in {}.",
        learners[static_cast<std::size_t>(best - summary.learners.begin())].name,
        fleet::kTuning.clear_difference, percent_of(best->best, best->judged),
        learners.size() > 1 ? ", the most of all learners" : "",
        percent_of(best->least_squares.better, best->judged),
        percent_of(best->least_squares.worse, best->judged)));
  }
  if (study.change != nullptr) {
    const auto worse = std::ranges::count_if(study.change->gains, [](const fleet::Gain& gain) {
      return gain.lost > 0 || gain.difference.median < -fleet::kTuning.clear_difference;
    });
    const auto better = std::ranges::count_if(study.change->gains, [](const fleet::Gain& gain) {
      return gain.difference.median > fleet::kTuning.clear_difference;
    });
    sentences.push_back(fmt::format(
        "Since {}, of {} (a learner on a vehicle's axis), {} became better by more than {} and {} "
        "worse (median over the runs that both have).",
        study.change->file, counted(study.change->gains.size(), "figure"), better,
        fleet::kTuning.clear_difference, worse));
  }
  return sentences;
}

chart::TextTable learners_view(const StudyView& study) {
  chart::TextTable table{"Learners, over all vehicles and axes",
                         {"learner", "best", "better\nthan l. sq.", "worse", "short by,\nmedian",
                          "short by,\np90", "update", "p99", "of real\ntime", "memory"},
                         {}};
  for (std::size_t i = 0; i < study.summary.learners.size(); ++i) {
    const fleet::LearnerOverall& one = study.summary.learners[i];
    table.rows.push_back(
        {cell_name(study.results.plan().learners[i].name), percent_of(one.best, one.judged),
         percent_of(one.least_squares.better, one.judged),
         percent_of(one.least_squares.worse, one.judged), chart::decimal(one.shortfall.median),
         chart::decimal(one.shortfall.ninetieth), chart::duration(one.times.update_us.median),
         chart::duration(one.times.p99_us.median), real_time(one.times.share.median),
         memory_text(one.times.memory_bytes)});
  }
  table.notes.push_back(fmt::format(
      "Best: of the runs' axes those where no learner, nor least squares, nor the mean has an R² "
      "on held-out rows that is higher by more than {}. Better and worse than least squares: by "
      "more than that. Short by: R² to the best of them. Times of an update of all axes, and what "
      "updates take of real time: medians over the runs; they depend on the machine.",
      fleet::kTuning.clear_difference));
  return table;
}

chart::TextTable vehicles_view(const StudyView& study, const StudyMeasure& measure,
                               std::size_t most, double Spread::*of) {
  chart::TextTable table{std::string(measure.title), {"vehicle", "axis", "runs"}, {}};
  table.left = {0, 1};
  for (const fleet::LearnerConfig& learner : study.results.plan().learners) {
    table.head.push_back(in_lines(learner.name));
  }
  if (measure.least_squares != nullptr) {
    table.head.emplace_back("least\nsquares");
    table.head.push_back(in_lines(std::string(measure.other_name)));
  }
  std::vector<AxisOfVehicle> rows = all_axes(study);
  const std::size_t all = rows.size();
  if (all > most) {
    std::ranges::stable_sort(rows, {}, [&](const auto& row) {
      const double value = (row.second->learners.front().*measure.learner).*of;
      return std::isfinite(value) ? value : -HUGE_VAL;
    });
    rows.resize(most);
  }
  for (const auto& [vehicle, axis] : rows) {
    table.rows.push_back({cell_name(vehicle->name), cell_name(axis->name),
                          chart::grouped((axis->learners.front().*measure.learner).runs)});
    for (const fleet::LearnerSummary& learner : axis->learners) {
      table.rows.back().push_back(chart::decimal((learner.*measure.learner).*of));
    }
    if (measure.least_squares != nullptr) {
      table.rows.back().push_back(chart::decimal((axis->*measure.least_squares).*of));
      table.rows.back().push_back(chart::decimal((axis->*measure.other).*of));
    }
  }
  cut(table, all, "where " + study.results.plan().learners.front().name + " does worst");
  return table;
}

chart::TextTable gains_view(const StudyView& study) {
  chart::TextTable table{
      fmt::format("R² on held-out rows: now less then, over the runs that {} has as well",
                  study.change->file),
      {"vehicle", "axis", "learner", "runs", "median", "least", "better", "worse", "lost"},
      {}};
  table.left = {0, 1, 2};
  for (const fleet::Gain& gain : study.change->gains | std::views::take(kMostStudyRows)) {
    table.rows.push_back({cell_name(gain.vehicle), cell_name(gain.axis), cell_name(gain.learner),
                          chart::grouped(gain.difference.runs),
                          chart::decimal(gain.difference.median),
                          chart::decimal(gain.difference.least), chart::grouped(gain.now.better),
                          chart::grouped(gain.now.worse), chart::grouped(gain.lost)});
  }
  table.notes.push_back(fmt::format(
      "Better, worse: runs by more than {}. Lost: runs that had an R² then and have none now. "
      "Only in this study: {} runs' axes; only in the earlier one: {}.",
      fleet::kTuning.clear_difference, chart::grouped(study.change->only_now),
      chart::grouped(study.change->only_then)));
  cut(table, study.change->gains.size(), "what has lost most");
  return table;
}

chart::TextTable changed_runs_view(const StudyView& study) {
  chart::TextTable table{
      "Runs that have lost most", {"log", "vehicle", "axis", "learner", "then", "now"}, {}};
  table.left = {0, 1, 2, 3};
  for (const fleet::ChangedRun& run : study.change->worst) {
    const fleet::Combination one = study.results.combinations()[run.combination];
    table.rows.push_back(
        {run_text(study, run.combination), cell_name(mission_at(study, run.combination).vehicle),
         cell_name(run.axis), cell_name(study.results.plan().learners[one.learner].name),
         chart::decimal(run.then), chart::decimal(run.now)});
  }
  return table;
}

chart::TextTable trends_view(const StudyView& study) {
  chart::TextTable table{"Trends from mission to mission",
                         {"vehicle", "axis", "missions", "early", "late", "chance", ""},
                         {}};
  table.left = {0, 1, 6};
  std::vector<AxisOfVehicle> tested = all_axes(study);
  std::erase_if(tested, [](const auto& one) { return !std::isfinite(one.second->trend.chance); });
  std::ranges::stable_sort(tested, {}, [](const auto& one) { return one.second->trend.chance; });
  for (const auto& [vehicle, axis] : tested | std::views::take(kMostListed)) {
    const fleet::Trend& trend = axis->trend;
    const bool out = fleet::stands_out(trend, study.summary.trends);
    table.rows.push_back({cell_name(vehicle->name), cell_name(axis->name),
                          chart::grouped(trend.missions.size()), chart::decimal(trend.early),
                          chart::decimal(trend.late), fmt::format("{:.2g}", trend.chance),
                          !out                       ? ""
                          : trend.late < trend.early ? "falls"
                                                     : "rises"});
  }
  table.notes.push_back(fmt::format(
      "R² on held-out rows of {}, each mission learned anew, in the order of the logs' names: "
      "medians of the first and the last third, and the chance of so strong a trend where there is "
      "none (Mann and Kendall's test). Falls, rises: chance below 0.05 also when {} are tested, "
      "and by more than {}. R² falls as well where missions become calmer or noisier: look at "
      "the logs.",
      study.results.plan().learners.front().name, counted(study.summary.trends, "trend"),
      fleet::kTuning.clear_difference));
  cut(table, tested.size(), "the least likely by chance");
  return table;
}

std::string findings_headline(const StudyView& study) {
  const std::vector<VehicleSummary>& vehicles = study.summary.vehicles;
  std::vector<std::string> changed;
  for (const VehicleSummary& vehicle : vehicles) {
    if (!vehicle.findings.empty()) {
      changed.push_back(cell_name(vehicle.name));
    }
  }
  if (changed.empty()) {
    return fmt::format("No change was found on {}.", counted(vehicles.size(), "vehicle"));
  }
  return changed.size() <= kMostNamed
             ? fmt::format("Changes were found on {}.", chart::list_text(changed))
             : fmt::format("Changes were found on {} of {}.", changed.size(),
                           counted(vehicles.size(), "vehicle"));
}

std::size_t findings_count(const StudyView& study) {
  std::size_t count = 0;
  for (const VehicleSummary& vehicle : study.summary.vehicles) {
    for (const fleet::MissionFindings& one : vehicle.findings) {
      count += one.findings.size();
    }
  }
  return count;
}

chart::TextTable vehicle_findings_view(const StudyView& study) {
  chart::TextTable table{
      "Which vehicle has what", {"vehicle", "missions", "the last finding", "in"}, {}};
  table.left = {0, 2, 3};
  std::size_t all = 0;
  for (const VehicleSummary& vehicle : study.summary.vehicles) {
    if (vehicle.findings.empty()) {
      continue;
    }
    ++all;
    if (table.rows.size() < kMostListed) {
      const fleet::MissionFindings& last = vehicle.findings.back();
      table.rows.push_back({cell_name(vehicle.name),
                            fmt::format("{} of {}", vehicle.findings.size(), vehicle.missions),
                            last.findings.back(), study.results.missions()[last.mission].mission});
    }
  }
  cut(table, all, "the first");
  return table;
}

chart::TextTable findings_view(const StudyView& study) {
  chart::TextTable table{
      "Findings by mission", {"vehicle", "mission", "found", "left at the end"}, {}};
  table.left = {0, 1, 2, 3};
  for (const VehicleSummary& vehicle : study.summary.vehicles) {
    for (const fleet::MissionFindings& one : vehicle.findings) {
      for (const std::string& finding : one.findings) {
        if (table.rows.size() < kMostListed) {
          const bool is_last = &finding == &one.findings.back();
          table.rows.push_back({cell_name(vehicle.name),
                                study.results.missions()[one.mission].mission, finding,
                                is_last ? one.left : ""});
        }
      }
    }
  }
  cut(table, findings_count(study), "the first");
  return table;
}

chart::TextTable worst_view(const StudyView& study) {
  const std::string& learner = study.results.plan().learners.front().name;
  chart::TextTable table{"R² on held-out rows, the worst runs of " + learner,
                         {"log", "vehicle", "axis", in_lines(learner), "least\nsquares", "mean"},
                         {}};
  table.left = {0, 1, 2};
  for (const fleet::RunScore& run : study.summary.worst) {
    table.rows.push_back({run_text(study, run.combination),
                          cell_name(mission_at(study, run.combination).vehicle),
                          cell_name(run.axis), chart::decimal(run.r2),
                          chart::decimal(run.least_squares), chart::decimal(run.mean)});
  }
  return table;
}

chart::TextTable failures_view(const StudyView& study) {
  chart::TextTable table{"Runs without a result", {"log", "learner", "why"}, {}};
  table.left = {0, 1, 2};
  table.whole = true;
  for (const auto& [i, why] : study.results.failures() | std::views::take(kMostListed)) {
    const fleet::Combination one = study.results.combinations()[i];
    table.rows.push_back(
        {run_text(study, i), cell_name(study.results.plan().learners[one.learner].name), why});
  }
  cut(table, study.results.failures().size(), "the first");
  return table;
}

}  // namespace kelpie::report
