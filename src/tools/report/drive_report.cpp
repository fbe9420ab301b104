// SPDX-License-Identifier: Apache-2.0
#include "report/drive_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "chart/figure.hpp"
#include "chart/page.hpp"
#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "core/angle.hpp"

namespace kelpie::report {
namespace {

constexpr std::size_t kMostLines = 7;  // of a figure
constexpr double kMostShare = 10.0;    // an interval wider than the value says nothing
constexpr double kBesideAim = 0.05;    // of a linear axis, beyond its numbers
constexpr double kBelowAim = 1.25;     // of a logarithmic one

double degrees(double rad) {
  return rad / kRadPerDegree;
}

std::string number_of(const format::PlannedDrive& drive, double number) {
  if (drive.parts) {
    return fmt::format("{:.1f} nats", number);
  }
  return number < kMostShare ? fmt::format("± {:.1f} %", 100.0 * number) : "not told";
}

bool is_reached(const format::PlannedDrive& drive, double number) {
  return drive.parts ? number >= drive.aim : number <= drive.aim;
}

// When a number reaches the aim for good.
std::optional<double> reached_s(const format::PlannedDrive& drive, std::size_t which) {
  std::optional<double> since;
  for (const study::DriveMoment& moment : drive.plan.countdown) {
    const bool reached = is_reached(drive, moment.numbers[which]);
    since = !reached ? std::nullopt : since ? since : std::optional(moment.t_s);
  }
  return since;
}

// Places of the numbers, the widest at the start first.
std::vector<std::size_t> by_need(const format::PlannedDrive& drive) {
  const std::vector<double>& start = drive.plan.countdown.front().numbers;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < start.size(); ++i) {
    places.push_back(i);
  }
  std::ranges::stable_sort(places, [&](std::size_t a, std::size_t b) {
    return drive.parts ? start[a] < start[b] : start[a] > start[b];
  });
  return places;
}

double worst_of(const format::PlannedDrive& drive, const study::DriveMoment& moment) {
  return drive.parts ? std::ranges::min(moment.numbers) : std::ranges::max(moment.numbers);
}

chart::TextTable numbers_view(const format::PlannedDrive& drive) {
  chart::TextTable table{
      drive.parts ? "Two causes apart (evidence)" : "Parameters: half width of the 90 % interval",
      {drive.parts ? "causes" : "parameter", "now", "after the drive",
       drive.parts ? fmt::format("{:g} nats after", drive.aim)
                   : fmt::format("± {:g} % after", 100.0 * drive.aim)},
      {}};
  for (const std::size_t i : by_need(drive)) {
    const std::optional<double> since = reached_s(drive, i);
    table.rows.push_back({chart::shortened(drive.plan.names[i], chart::kLongestName),
                          number_of(drive, drive.plan.countdown.front().numbers[i]),
                          number_of(drive, drive.plan.countdown.back().numbers[i]),
                          since ? fmt::format("{:g} s", *since) : "–"});
  }
  return table;
}

chart::TextTable manoeuvres_view(const format::PlannedDrive& drive) {
  chart::TextTable table{"Manoeuvres", {"from s", "manoeuvre", "then", "told"}, {}};
  for (std::size_t i = 1; i < drive.plan.countdown.size(); ++i) {
    const study::DriveMoment& moment = drive.plan.countdown[i];
    const auto told = std::ranges::count_if(
        moment.numbers, [&](double number) { return is_reached(drive, number); });
    table.rows.push_back({fmt::format("{:g}", drive.plan.countdown[i - 1].t_s), moment.manoeuvre,
                          number_of(drive, worst_of(drive, moment)),
                          fmt::format("{} of {}", told, moment.numbers.size())});
  }
  table.left = {1};
  table.whole = true;
  table.notes = {drive.parts ? "then: evidence" : "then: the widest interval"};
  return table;
}

// From the least to the greatest number of these parameters, the aim among them.
chart::Extent countdown_range(const format::PlannedDrive& drive,
                              std::span<const std::size_t> places, double factor) {
  std::vector<double> numbers{factor * drive.aim};
  for (const study::DriveMoment& moment : drive.plan.countdown) {
    for (const std::size_t place : places) {
      numbers.push_back(factor * moment.numbers[place]);
    }
  }
  const chart::Extent range = chart::range_of(numbers);
  const double beside = kBesideAim * (range.high - range.low);
  return drive.parts ? chart::Extent{range.low, range.high + beside}
                     : chart::Extent{range.low / kBelowAim, range.high * kBelowAim};
}

std::string countdown_figure(const format::PlannedDrive& drive) {
  const std::vector<std::size_t> places = by_need(drive);
  const double factor = drive.parts ? 1.0 : 100.0;
  chart::Figure figure(
      {.label = "time in s"},
      {.label = drive.parts ? "evidence in nats" : "half width of the 90 % interval in %",
       .range = countdown_range(drive, std::span(places).first(std::min(places.size(), kMostLines)),
                                factor),
       .kind = drive.parts ? chart::ScaleKind::linear : chart::ScaleKind::logarithmic},
      "What is known on the way");
  for (std::size_t line = 0; line < std::min(places.size(), kMostLines); ++line) {
    std::vector<chart::Point> points;
    for (const study::DriveMoment& moment : drive.plan.countdown) {
      points.push_back({moment.t_s, factor * moment.numbers[places[line]]});
    }
    figure.line(points, line, drive.plan.names[places[line]]);
  }
  figure.reference({0.0, factor * drive.aim}, {drive.plan.duration_s(), factor * drive.aim});
  return figure.html(places.size() > kMostLines
                         ? fmt::format("The {} least known of {} parameters; the line is the aim",
                                       kMostLines, places.size())
                         : "The line is the aim");
}

std::string track_figure(const format::PlannedDrive& drive) {
  // The track fills the figure, however wide the bound is.
  const double radius = std::min(drive.bounds.radius_m, 1.25 * drive.plan.extent.farthest_m);
  chart::Figure figure({.label = "x in m", .range = chart::Extent{-radius, radius}},
                       {.label = "y in m", .range = chart::Extent{-radius, radius}},
                       "Track of the identified vehicle");
  figure.make_square();
  std::vector<chart::Point> track;
  for (const study::DriveMotion& motion : drive.plan.track) {
    track.push_back({motion.position_m[0], motion.position_m[1]});
  }
  figure.dots(track, 0, "identified vehicle");
  return figure.html(fmt::format(
      "At most {:.1f} m from the start (bound {:g}) and {:.2f} m/s, for all vehicles "
      "that the log allows",
      drive.plan.extent.farthest_m, drive.bounds.radius_m, drive.plan.extent.fastest_m_s));
}

// Depth, roll and pitch over time.
std::string attitude_figure(const format::PlannedDrive& drive) {
  chart::Figure figure({.label = "time in s"}, {.label = "m, °"},
                       "Depth and attitude of the identified vehicle");
  std::vector<std::vector<chart::Point>> lines(3);
  for (std::size_t i = 0; i < drive.plan.track.size(); ++i) {
    const double t_s = study::kManoeuvreStepS * static_cast<double>(i);
    const study::DriveMotion& motion = drive.plan.track[i];
    lines[0].push_back({t_s, motion.position_m[2]});
    lines[1].push_back({t_s, degrees(motion.angles_rad[0])});
    lines[2].push_back({t_s, degrees(motion.angles_rad[1])});
  }
  figure.line(lines[0], 0, "depth below the start in m");
  figure.line(lines[1], 1, "roll in °");
  figure.line(lines[2], 2, "pitch in °");
  return figure.html(
      fmt::format("At most {:.1f} m and {:.0f}°, for all vehicles that the log allows",
                  drive.plan.extent.depth_m, degrees(drive.plan.extent.tilt_rad)));
}

std::string drive_headline(const format::PlannedDrive& drive) {
  const study::DrivePlan& plan = drive.plan;
  if (plan.manoeuvres.empty()) {
    return "All that is wanted is told by the log already";
  }
  const std::size_t first = by_need(drive).front();
  const std::string least =
      fmt::format("{} {} → {} in {:g} s", plan.names[first],
                  number_of(drive, plan.countdown.front().numbers[first]),
                  number_of(drive, plan.countdown.back().numbers[first]), plan.duration_s());
  return plan.reached ? least : least + ": the bounds leave no more";
}

}  // namespace

std::string drive_verdict(const format::PlannedDrive& drive) {
  const study::DrivePlan& plan = drive.plan;
  std::string text = drive_headline(drive) + "\n";
  text += fmt::format(
      "{} manoeuvre{}; at most {:.1f} m from the start (bound {:g}) and {:.2f} m/s (bound {:g}),\n",
      plan.manoeuvres.size(), plan.manoeuvres.size() == 1 ? "" : "s", plan.extent.farthest_m,
      drive.bounds.radius_m, plan.extent.fastest_m_s, drive.bounds.speed_m_s);
  if (drive.six_axes) {
    text +=
        fmt::format("{:.1f} m of depth (bound {:g}) and {:.0f}° of roll or pitch (bound {:.0f}),\n",
                    plan.extent.depth_m, drive.bounds.depth_m, degrees(plan.extent.tilt_rad),
                    degrees(drive.bounds.tilt_rad));
  }
  text += "by all vehicles that the log allows\n\n";
  text += chart::table_text(numbers_view(drive));
  if (!drive.has_scale && !drive.parts) {
    text += "Of ratios to the surge inertia; --thrust NAME=K gives the scale.\n";
  }
  return text;
}

std::string drive_tables(const format::PlannedDrive& drive) {
  return chart::table_text(manoeuvres_view(drive));
}

std::string drive_html(const format::PlannedDrive& drive) {
  const std::string log = chart::file_names(drive.source);
  const std::string opening = chart::paragraph("over", "Drive this next, by " + log) +
                              chart::heading(1, drive_headline(drive) + ".");
  if (drive.plan.manoeuvres.empty()) {
    return chart::html_page("kelpie: plan, " + log, opening,
                            {{"What is known", chart::html_table(numbers_view(drive))}});
  }
  return chart::html_page(
      "kelpie: plan, " + log, opening,
      {{"Countdown", countdown_figure(drive)},
       {"What is known", chart::html_table(numbers_view(drive))},
       {"Manoeuvres", chart::html_table(manoeuvres_view(drive))},
       {"Track", track_figure(drive) + (drive.six_axes ? attitude_figure(drive) : "")}});
}

}  // namespace kelpie::report
