// SPDX-License-Identifier: Apache-2.0
#include "report/study_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart/figure.hpp"
#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "core/text.hpp"
#include "report/stream_tables.hpp"
#include "report/tuning.hpp"

namespace kelpie::report {
namespace {

using fleet::AxisSummary;
using fleet::VehicleSummary;

constexpr std::size_t kMostVehicles = 12;  // that a figure on a phone can name
constexpr std::size_t kMostFigures = 6;
constexpr std::size_t kLongestVehicle = 14;
constexpr double kBesides = 0.7;  // of a place's width, for all learners

struct Placed {
  const VehicleSummary* vehicle;
  const AxisSummary* axis;
};

// The vehicles that have an axis of this name; of too many those where the first learner does
// worst.
std::vector<Placed> vehicles_with(const StudyView& study, const std::string& name) {
  std::vector<Placed> found;
  for (const VehicleSummary& vehicle : study.summary.vehicles) {
    const auto axis = std::ranges::find(vehicle.axes, name, &AxisSummary::name);
    if (axis != vehicle.axes.end()) {
      found.push_back({&vehicle, &*axis});
    }
  }
  if (found.size() > kMostVehicles) {
    std::ranges::stable_sort(found, {}, [](const Placed& one) {
      const double value = one.axis->learners.front().r2_final.median;
      return std::isfinite(value) ? value : -HUGE_VAL;
    });
    found.resize(kMostVehicles);
  }
  return found;
}

double drawn(double r2) {
  return std::max(r2, kTuning.lowest_r2);
}

// The lower end of the figure, of learners and least squares: the mean would press them together.
double lowest_drawn(const StudyView& study, const std::vector<Placed>& vehicles) {
  double low = 0.9;
  for (const Placed& one : vehicles) {
    for (std::size_t i = 0; i < study.results.plan().learners.size(); ++i) {
      low = std::fmin(low, drawn(one.axis->learners[i].r2_final.tenth));
    }
    low = std::fmin(low, drawn(one.axis->least_squares.tenth));
  }
  return low;
}

std::string vehicle_figure(const StudyView& study, const std::string& name) {
  const std::vector<Placed> vehicles = vehicles_with(study, name);
  chart::PlotAxis places{"vehicle",
                         chart::Extent{-0.5, static_cast<double>(vehicles.size()) - 0.5}};
  for (const Placed& one : vehicles) {
    places.names.push_back(chart::shortened(one.vehicle->name, kLongestVehicle));
  }
  const double low = lowest_drawn(study, vehicles);
  chart::Figure figure(
      places,
      {"R² of " + chart::shortened(name, chart::kLongestName), chart::Extent{low - 0.02, 1.02}},
      "R² on held-out rows of " + name + " by vehicle and learner");
  const std::vector<fleet::LearnerConfig>& learners = study.results.plan().learners;
  const auto series = static_cast<double>(learners.size() + 2);
  const auto draw = [&](std::size_t style, const std::string& who, auto spread) {
    const double beside = kBesides * ((static_cast<double>(style) + 0.5) / series - 0.5);
    std::vector<chart::Point> medians;
    std::vector<chart::Point> tenths;
    for (std::size_t i = 0; i < vehicles.size(); ++i) {
      const fleet::Spread& values = spread(*vehicles[i].axis);
      medians.push_back({static_cast<double>(i) + beside, std::max(values.median, low)});
      tenths.push_back({static_cast<double>(i) + beside, std::max(values.tenth, low)});
    }
    figure.markers(medians, style, who);
    figure.dots(tenths, style, "");
  };
  for (std::size_t i = 0; i < learners.size(); ++i) {
    draw(i, learners[i].name,
         [i](const AxisSummary& axis) -> const auto& { return axis.learners[i].r2_final; });
  }
  draw(learners.size(), "least squares",
       [](const AxisSummary& axis) -> const auto& { return axis.least_squares; });
  draw(learners.size() + 1, "mean",
       [](const AxisSummary& axis) -> const auto& { return axis.mean; });
  return figure.html(fmt::format(
      "At the end of the stream: medians over the runs, small dots the 10th percentile. What lies "
      "below {:.2g} is drawn there.{}",
      low,
      study.summary.vehicles.size() > kMostVehicles
          ? fmt::format(" The {} vehicles where {} does worst.", kMostVehicles,
                        learners.front().name)
          : ""));
}

// The least chance of the vehicle's trends, 1 without any.
double least_chance(const VehicleSummary& vehicle) {
  double least = 1.0;
  for (const AxisSummary& axis : vehicle.axes) {
    least = std::fmin(least, axis.trend.chance);
  }
  return least;
}

std::string trend_figure(const StudyView& study, const VehicleSummary& vehicle) {
  chart::Figure figure({"mission, in the order of names", {}}, {"R²", {}},
                       "R² on held-out rows of " + vehicle.name + " from mission to mission");
  for (std::size_t i = 0; i < vehicle.axes.size(); ++i) {
    const fleet::Trend& trend = vehicle.axes[i].trend;
    std::vector<chart::Point> points;
    for (std::size_t k = 0; k < trend.r2.size(); ++k) {
      points.push_back({static_cast<double>(k + 1), drawn(trend.r2[k])});
    }
    const std::string name = chart::shortened(vehicle.axes[i].name, chart::kLongestName);
    if (points.size() > 100) {
      figure.dots(points, i, name);
    } else {
      figure.markers(points, i, name);
    }
  }
  return figure.html(fmt::format("{}: R² on held-out rows of {}, each mission learned anew.",
                                 vehicle.name, study.results.plan().learners.front().name));
}

}  // namespace

std::vector<std::string> vehicle_figures(const StudyView& study) {
  std::vector<std::string> names;
  for (const VehicleSummary& vehicle : study.summary.vehicles) {
    for (const AxisSummary& axis : vehicle.axes) {
      if (names.size() < kMostFigures && std::ranges::count(names, axis.name) == 0) {
        names.push_back(axis.name);
      }
    }
  }
  std::vector<std::string> figures;
  for (const std::string& name : names) {
    figures.push_back(vehicle_figure(study, name));
  }
  return figures;
}

std::vector<std::string> trend_figures(const StudyView& study) {
  std::vector<const VehicleSummary*> vehicles;
  for (const VehicleSummary& vehicle : study.summary.vehicles) {
    if (least_chance(vehicle) < 1.0) {
      vehicles.push_back(&vehicle);
    }
  }
  std::ranges::stable_sort(vehicles, {},
                           [](const VehicleSummary* one) { return least_chance(*one); });
  vehicles.resize(std::min(vehicles.size(), kMostFigures));
  std::vector<std::string> figures;
  for (const VehicleSummary* const vehicle : vehicles) {
    figures.push_back(trend_figure(study, *vehicle));
  }
  return figures;
}

namespace {

constexpr std::size_t kTerminalRows = 30;

std::string if_any(const chart::TextTable& table, const std::string& before = "") {
  return table.rows.empty() ? "" : before + chart::html_table(table);
}

chart::Facts facts(const StudyView& study) {
  const fleet::Plan& plan = study.results.plan();
  chart::Facts list{{"study", plan.name}};
  for (const fleet::LearnerConfig& learner : plan.learners) {
    list.emplace_back("learner " + learner.name,
                      learner.set.empty() ? "as it is" : join_text(learner.set, " "));
  }
  std::string splits;
  for (const fleet::SplitOptions& split : plan.splits) {
    splits += fmt::format("{}{} (seed {})", splits.empty() ? "" : ", ", split.split, split.seed);
  }
  list.emplace_back("splits", splits);
  list.emplace_back("time of all runs", chart::duration(1e6 * study.summary.seconds));
  return list;
}

}  // namespace

std::string study_table(const StudyView& study) {
  std::string text;
  for (const std::string& sentence : study_sentences(study)) {
    text += chart::wrapped(chart::safe_text(sentence)) + "\n";
  }
  text += "\n" + chart::table_text(learners_view(study));
  for (const StudyMeasure& measure : {kStudyFinal, kStudyOneStep}) {
    text += chart::table_text(vehicles_view(study, measure, kTerminalRows));
  }
  if (study.change != nullptr) {
    chart::TextTable gains = gains_view(study);
    gains.rows.resize(std::min(gains.rows.size(), kTerminalRows));
    text += chart::table_text(gains);
  }
  if (const chart::TextTable failures = failures_view(study); !failures.rows.empty()) {
    text += chart::table_text(failures);
  }
  return text;
}

std::string study_html(const StudyView& study) {
  const std::string title = "kelpie: study " + study.results.plan().name;
  const std::vector<std::string> sentences = study_sentences(study);
  std::string opening =
      chart::paragraph("over", title) + chart::heading(1, findings_headline(study));
  for (const std::string& sentence : sentences) {
    opening += chart::paragraph("", sentence);
  }
  opening += if_any(vehicle_findings_view(study));
  opening += chart::paragraph("note",
                              "Each run learns one log anew, in the order of time, and is "
                              "judged on rows held out of it. " +
                                  std::string(kBaselineNote));
  const std::string vehicles = chart::panels(vehicle_figures(study)) +
                               chart::html_tables({vehicles_view(study, kStudyFinal)});
  chart::TextTable tenth = vehicles_view(study, kStudyFinal, kMostStudyRows, &fleet::Spread::tenth);
  tenth.title = "R² on held-out rows, at the end: 10th percentile over the runs";
  std::string more;
  for (const StudyMeasure& measure : {kStudyOneStep, kStudyMean, kStudyCoverage}) {
    more += chart::html_tables({vehicles_view(study, measure)});
  }
  const bool tested = study.summary.trends > 0;
  return chart::html_page(
      title, opening,
      {{"Since the earlier study",
        study.change == nullptr
            ? ""
            : if_any(gains_view(study)) +
                  if_any(changed_runs_view(study), chart::heading(3, "Runs that have lost most"))},
       {"Vehicles", vehicles + chart::folded(tenth.title, chart::html_table(tenth))},
       {"From mission to mission",
        tested ? chart::panels(trend_figures(study)) + if_any(trends_view(study)) : ""},
       {"Findings by mission", if_any(findings_view(study))},
       {"Failures", if_any(failures_view(study))},
       {"Learners", if_any(learners_view(study)), true},
       {"One step ahead, over the stream, intervals", more, true},
       {"Worst runs", if_any(worst_view(study)), true},
       {"The study", chart::facts_table(facts(study)), true}});
}

}  // namespace kelpie::report
