// SPDX-License-Identifier: Apache-2.0
#include "report/identification_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart/page.hpp"
#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "core/text.hpp"
#include "format/parameters.hpp"
#include "report/certificate_table.hpp"
#include "report/tuning.hpp"

namespace kelpie::report {
namespace {

constexpr std::size_t kMostShown = 2000;  // rows in a figure

chart::TextTable parameters_view(const study::Identification& found) {
  chart::TextTable table{
      "Parameters", {"parameter", "value", "90 % interval", "± %", "unit", ""}, {}};
  for (std::size_t i = 0; i < found.fit().parameters.size(); ++i) {
    const FittedParameter& parameter = found.fit().parameters[i];
    const std::string name = chart::shortened(parameter.name, chart::kLongestName);
    const std::string unit = chart::unit_text(format::parameter_unit(found, i));
    if (parameter.state == ParameterState::not_told) {
      table.rows.push_back({name, "–", "–", "–", unit, "not told"});
      continue;
    }
    const double half = format::half_width90(parameter);
    const bool has_share = half < 2.0 * std::abs(parameter.value);
    table.rows.push_back(
        {name, chart::significant(parameter.value),
         chart::significant(parameter.value - half) + " to " +
             chart::significant(parameter.value + half),
         has_share ? fmt::format("{:.1f}", 100.0 * half / std::abs(parameter.value)) : "–", unit,
         parameter.state == ParameterState::identified ? "" : format::state_word(parameter.state)});
  }
  table.left = {0, 4, 5};
  return table;
}

// The parameters that the log tells, as bars.
std::string parameter_bars(const study::Identification& found) {
  std::vector<chart::IntervalRow> rows;
  for (std::size_t i = 0; i < found.fit().parameters.size(); ++i) {
    const FittedParameter& parameter = found.fit().parameters[i];
    if (parameter.state == ParameterState::not_told || !std::isfinite(parameter.value)) {
      continue;
    }
    const double half = format::half_width90(parameter);
    const std::string unit = chart::unit_text(format::parameter_unit(found, i));
    const bool is_free = parameter.state == ParameterState::identified;
    rows.push_back({chart::shortened(parameter.name, chart::kLongestName), parameter.value,
                    parameter.value - half, parameter.value + half,
                    chart::significant(parameter.value) + (unit == "1" ? "" : " " + unit),
                    is_free ? "" : format::state_word(parameter.state)});
  }
  if (rows.empty()) {
    return "";
  }
  return chart::interval_table(rows) +
         chart::paragraph("note",
                          found.six
                              ? "low_centre, forward_centre: the centre of gravity off the origin, "
                                "times the mass. roll_moment, pitch_moment, righting_moment: "
                                "centres of gravity and buoyancy apart, along x, y, z."
                              : "surge_force, sway_force, yaw_moment: a constant push, "
                                "as of trim, a tether or an offset of a sensor.");
}

// Whether the structure lies farther from the log than noise takes it: intervals count noise.
bool misses_forces(const study::Identification& found) {
  return !found.of_poses && found.fit().misfit > kTuning.high_misfit;
}

std::string misfit_text(const study::Identification& found) {
  return fmt::format(
      "WARNING: misfit {:.1f}, where noise alone gives 1: the equation misses forces that moved "
      "this vehicle, and the 90 % intervals are too narrow. Likely causes: {}.",
      found.fit().misfit,
      found.six
          ? "thrusters with curves of their own or in each other's wake, couplings of drag, a "
            "current"
          : "a battery that sags, a dead band, commands that do not tell the thrust, lift, a "
            "current");
}

// How far the parameters can be trusted, in one sentence.
std::string headline(const study::Identification& found, std::size_t told) {
  if (told == 0) {
    return "No parameter was identified: the log does not tell the vehicle's masses, drags and "
           "thrusts apart";
  }
  std::vector<std::string> good;
  std::vector<std::string> poor;
  for (std::size_t axis = 0; !found.held_out.times_s.empty() && axis < found.targets.size();
       ++axis) {
    (found.held_out.r2[axis] >= kTuning.poor_r2 ? good : poor).push_back(found.targets[axis]);
  }
  const std::string count =
      fmt::format("{} of {} parameters identified", told, found.fit().parameters.size());
  return poor.empty()   ? count + (misses_forces(found)
                                       ? fmt::format(", with intervals that are too narrow (misfit "
                                                       "{:.1f})",
                                                     found.fit().misfit)
                                       : "")
         : good.empty() ? count + ", but they predict no axis well: do not trust them"
                        : count + "; trust those of " + chart::list_text(good) + ", not those of " +
                              chart::list_text(poor);
}

chart::TextTable actuators_view(const study::Identification& found) {
  chart::TextTable table{"Time constants of actuators", {"command", "lag/s", "90 % interval"}, {}};
  for (const LagInterval& lag : found.lags) {
    const std::string low = chart::significant(lag.low_s);
    table.rows.push_back({chart::shortened(lag.command, chart::kLongestName),
                          chart::significant(lag.lag_s),
                          std::isfinite(lag.high_s) ? low + " to " + chart::significant(lag.high_s)
                                                    : "above " + low});
  }
  return table;
}

chart::TextTable held_out_view(const study::Identification& found) {
  chart::TextTable table{"R² of accelerations on held-out rows",
                         {"axis", "identified\nvehicle", "same terms,\nuntied", "mean"},
                         {}};
  if (found.held_out.times_s.empty()) {
    return table;
  }
  for (std::size_t axis = 0; axis < found.targets.size(); ++axis) {
    table.rows.push_back({chart::shortened(found.targets[axis], chart::kLongestName),
                          chart::decimal(found.held_out.r2[axis]),
                          chart::decimal(found.held_out.free_r2[axis]), chart::decimal(0.0)});
  }
  table.notes = {"same terms, untied: least squares on the same terms, each axis by itself"};
  return table;
}

chart::TextTable correlations_view(const study::Identification& found) {
  chart::TextTable table{"Strongest correlations of errors", {"parameters", "correlation"}, {}};
  std::vector<std::pair<double, std::string>> pairs;
  const std::vector<FittedParameter>& parameters = found.fit().parameters;
  for (std::size_t a = 0; a < parameters.size(); ++a) {
    for (std::size_t b = a + 1; b < parameters.size(); ++b) {
      const double correlation = found.fit().correlation(a, b);
      if (std::abs(correlation) >= kTuning.high_correlation) {
        pairs.emplace_back(correlation, parameters[a].name + ", " + parameters[b].name);
      }
    }
  }
  std::ranges::sort(
      pairs, [](const auto& a, const auto& b) { return std::abs(a.first) > std::abs(b.first); });
  pairs.resize(std::min<std::size_t>(pairs.size(), 20));
  for (const auto& [correlation, names] : pairs) {
    table.rows.push_back({names, chart::decimal(correlation)});
  }
  return table;
}

// The stretch of kTuning.first_window_s in which the values reach farthest.
chart::Extent liveliest(const std::vector<double>& times, const std::vector<double>& values) {
  chart::Extent best{times.front(), times.back()};
  double widest = -1.0;
  for (double from = times.front(); from < times.back(); from += 0.5 * kTuning.first_window_s) {
    const auto place = [&](double time) {
      return std::ranges::lower_bound(times, time) - times.begin();
    };
    const auto [low, high] = std::minmax_element(
        values.begin() + place(from), values.begin() + place(from + kTuning.first_window_s));
    if (low != high && *high - *low > widest) {
      widest = *high - *low;
      best = {from, from + kTuning.first_window_s};
    }
  }
  return best;
}

std::string axis_figure(const study::Identification& found, std::size_t axis) {
  const study::HeldOutFit& held_out = found.held_out;
  const std::size_t straight =
      found.targets.size() == kPlanarAxes ? kPlanarAxes - 1 : found.targets.size() / 2;
  chart::Figure figure(
      {.label = "time in s"},
      {.label = found.targets[axis] + (axis < straight ? " in m/s²" : " in rad/s²")},
      "Acceleration of held-out rows, measured and by the identified vehicle");
  figure.link("time");
  if (!held_out.times_s.empty()) {
    figure.begin_at(liveliest(held_out.times_s, held_out.measured.front()));
  }
  const std::size_t shown = std::min(held_out.times_s.size(), kMostShown);
  const auto points = [&](const std::vector<double>& values) {
    std::vector<chart::Point> line;
    for (std::size_t i = 0; i < shown; ++i) {
      if (i > 0 && held_out.times_s[i] - held_out.times_s[i - 1] > 10.0) {
        line.push_back({held_out.times_s[i - 1], std::nan("")});
      }
      line.push_back({held_out.times_s[i], values[i]});
    }
    return line;
  };
  figure.line(points(held_out.measured[axis]), 0, "measured");
  figure.line(points(held_out.structure[axis]), 1, "identified vehicle");
  const std::size_t rows = held_out.times_s.size();
  return figure.html((shown < rows ? chart::grouped(shown) + " of " : "") + chart::grouped(rows) +
                     " held-out rows; R² of all " + chart::decimal(held_out.r2[axis]));
}

}  // namespace

std::vector<std::string> identification_remarks(const study::Identification& found) {
  std::vector<std::string> remarks;
  if (misses_forces(found)) {
    remarks.push_back(misfit_text(found));
  }
  if (!found.fins.empty()) {
    remarks.push_back("WARNING: " + study::fins_text(found.fins) +
                      ". Other parameters take their forces.");
  }
  switch (found.scale) {
    case study::ScaleSource::none:
      remarks.emplace_back(
          "Ratios only: masses, drags and thrusts are divided by the surge inertia (mass and added "
          "mass), for accelerations tell no more. --thrust NAME=K or --mass KG gives the scale.");
      break;
    case study::ScaleSource::assumed_added_mass:
      remarks.emplace_back(
          "A log tells mass and added mass in surge as a sum: the added mass is assumed to be 0.2 "
          "± 0.15 of the mass, which is most of the intervals. --thrust or --surge-added-mass does "
          "better.");
      break;
    case study::ScaleSource::vehicle_file:
      remarks.emplace_back(
          "A log tells mass and added mass in surge as a sum: the added mass is the vehicle "
          "file's, taken as exact. --thrust or --surge-added-mass gives another scale.");
      break;
    case study::ScaleSource::thrust:
    case study::ScaleSource::inertia:
      break;
  }
  std::vector<std::string> not_told;
  for (const FittedParameter& parameter : found.fit().parameters) {
    if (parameter.state == ParameterState::not_told) {
      not_told.push_back(parameter.name);
    }
  }
  if (!not_told.empty()) {
    remarks.push_back("The log doesn't tell " + join_text(not_told, ", ") +
                      " apart from others: left out.");
  }
  for (std::size_t axis = 0; !found.held_out.times_s.empty() && axis < found.targets.size();
       ++axis) {
    const double r2 = found.held_out.r2[axis];
    const double free = found.held_out.free_r2[axis];
    if (r2 < free - kTuning.structure_loss || r2 < kTuning.poor_r2) {
      remarks.push_back(fmt::format(
          "{}: R² {} on held-out rows, {} with the same terms untied: {}. Don't trust this axis' "
          "parameters further than that.",
          found.targets[axis], chart::decimal(r2), chart::decimal(free),
          r2 < free - kTuning.structure_loss
              ? "Fossen's structure with diagonal drag doesn't hold for it"
              : "the terms don't explain it"));
    }
  }
  std::ranges::copy(certificate_remarks(found.certificates), std::back_inserter(remarks));
  return remarks;
}

std::string identification_table(const study::Identification& found) {
  std::string text =
      fmt::format("{}\n{} training rows, {} windows of {:g} s; {}; misfit {:.2f}\n\n",
                  chart::safe_text(found.source), chart::grouped(found.training_rows),
                  chart::grouped(found.fit().windows), found.fit().window_s,
                  chart::safe_text(found.split), found.fit().misfit);
  if (!found.alignment.empty()) {
    text += chart::wrapped(chart::safe_text(found.alignment)) + "\n\n";
  }
  text += chart::table_text(parameters_view(found));
  if (!found.lags.empty()) {
    text += chart::table_text(actuators_view(found));
  }
  if (!found.held_out.times_s.empty()) {
    text += chart::table_text(held_out_view(found));
  }
  if (!found.certificates.engines.empty()) {
    text += chart::table_text(certificate_view(found.certificates));
  }
  for (const std::string& remark : identification_remarks(found)) {
    text += chart::wrapped(chart::safe_text(remark)) + "\n";
  }
  return text + "\n";
}

std::string identification_html(const study::Identification& found) {
  const std::string log = chart::file_names(found.source);
  const std::string bars = parameter_bars(found);
  const auto told = static_cast<std::size_t>(
      std::ranges::count_if(found.fit().parameters, [](const FittedParameter& parameter) {
        return parameter.state != ParameterState::not_told && std::isfinite(parameter.value);
      }));
  std::string opening = chart::paragraph("over", "Parameters identified from " + log) +
                        chart::heading(1, headline(found, told) + ".");
  for (const std::string& remark : identification_remarks(found)) {
    opening += chart::paragraph("", remark);
  }
  const chart::Section data{
      "Data",
      chart::facts_table(
          {{"log", found.source},
           {"alignment", found.alignment.empty() ? "–" : found.alignment},
           {"split", found.split},
           {"training rows", chart::grouped(found.training_rows)},
           {fmt::format("windows of {:g} s", found.fit().window_s),
            chart::grouped(found.fit().windows)},
           {"misfit of the structure (1: chance)", chart::significant(found.fit().misfit)}}),
      true};
  if (told == 0) {
    return chart::html_page("kelpie: identify, " + log, opening, {data});
  }
  std::string course;
  if (!found.held_out.times_s.empty()) {
    course = chart::html_table(held_out_view(found));
    for (std::size_t axis = 0; axis < found.targets.size(); ++axis) {
      course += chart::heading(3, found.targets[axis]) + axis_figure(found, axis);
    }
  }
  return chart::html_page(
      "kelpie: identify, " + log, opening,
      {{"Parameters",
        bars + chart::folded("All numbers", chart::html_table(parameters_view(found)))},
       {"Held-out rows", course},
       {"Simulators", found.certificates.engines.empty()
                          ? ""
                          : chart::html_table(certificate_view(found.certificates))},
       {"Time constants of actuators", chart::html_table(actuators_view(found))},
       {"Correlations", chart::html_table(correlations_view(found)), true},
       data});
}

}  // namespace kelpie::report
