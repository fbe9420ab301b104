// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/quantile.hpp"
#include "core/text.hpp"
#include "file/json.hpp"
#include "format/parameters.hpp"

namespace kelpie::format {
namespace {

// Some letters end a line of YAML within quotes, too.
std::string quoted(const std::string& text) {
  return file::one_line(printable(text, text.size()));
}

// YAML knows no NaN that all readers agree on.
std::string number(fmt::format_string<double> format, double value) {
  return std::isfinite(value) ? fmt::format(format, double{value}) : "null";
}

std::string parameter_line(const study::Identification& found, std::size_t place) {
  const FittedParameter& parameter = found.fit().parameters[place];
  const std::string head =
      fmt::format("  {}: {{unit: {}, state: {}", quoted(parameter.name),
                  quoted(parameter_unit(found, place)), quoted(state_word(parameter.state)));
  if (parameter.state == ParameterState::not_told) {
    return head + "}\n";
  }
  const double half = half_width90(parameter);
  return fmt::format("{}, value: {}, error: {}, interval90: [{}, {}]}}\n", head,
                     number("{:.6g}", parameter.value), number("{:.3g}", parameter.error),
                     number("{:.6g}", parameter.value - half),
                     number("{:.6g}", parameter.value + half));
}

// An interval without an upper end ends at infinity (YAML 1.2).
std::string actuators(const study::Identification& found) {
  std::string text = found.lags.empty() ? "" : "actuators:\n";
  for (const LagInterval& lag : found.lags) {
    text += fmt::format("  {}: {{unit: s, lag: {:.6g}, interval90: [{:.6g}, {}]}}\n",
                        quoted(lag.command), lag.lag_s, lag.low_s,
                        std::isfinite(lag.high_s) ? fmt::format("{:.6g}", lag.high_s) : ".inf");
  }
  return text;
}

std::string correlations(const study::Identification& found) {
  const std::vector<std::size_t> told = identified_places(found);
  std::string names;
  for (const std::size_t i : told) {
    names += (names.empty() ? "" : ", ") + quoted(found.fit().parameters[i].name);
  }
  std::string text = "correlations:\n  names: [" + names + "]\n  matrix:\n";
  for (const std::size_t a : told) {
    text += "    - [";
    for (const std::size_t b : told) {
      text += (b == told.front() ? "" : ", ") + number("{:.3f}", found.fit().correlation(a, b));
    }
    text += "]\n";
  }
  return text;
}

// Of SixAxisPlace; thrusts are those at full command.
std::string six_axis_unit(const study::Identification& found, std::size_t place) {
  constexpr std::array kUnits{"kg",
                              "kg",
                              "kg",
                              "kg m^2",
                              "kg m^2",
                              "kg m^2",
                              "kg m",
                              "kg m",
                              "N s/m",
                              "N s/m",
                              "N s/m",
                              "N m s/rad",
                              "N m s/rad",
                              "N m s/rad",
                              "N s^2/m^2",
                              "N s^2/m^2",
                              "N s^2/m^2",
                              "N m s^2/rad^2",
                              "N m s^2/rad^2",
                              "N m s^2/rad^2",
                              "N",
                              "N m",
                              "N m",
                              "N m"};
  constexpr std::array kCurve{"s", "s", "1", "1"};
  const std::size_t curve = SixAxisPlace::curve(found.six->thrusters.size());
  if (place >= curve) {
    return kCurve.at(place - curve);
  }
  const std::string unit = place < kUnits.size() ? kUnits[place] : "N";
  return found.scale != study::ScaleSource::none ? unit : "(" + unit + ")/kg";
}

}  // namespace

std::string scale_text(const study::Identification& found) {
  switch (found.scale) {
    case study::ScaleSource::thrust:
      return "thrust coefficients that were given";
    case study::ScaleSource::inertia:
      return "mass and added mass in surge that were given";
    case study::ScaleSource::vehicle_file:
      return "the mass, and the added mass in surge of the vehicle file, taken as exact";
    case study::ScaleSource::assumed_added_mass:
      return "the mass that was given; added mass in surge assumed, 0.2 ± 0.15 of it: the error of "
             "that is in every other";
    case study::ScaleSource::none:
      break;
  }
  return "none: all but angles and arms are divided by the surge inertia (mass and added mass)";
}

std::vector<std::size_t> identified_places(const study::Identification& found) {
  std::vector<std::size_t> told;
  for (std::size_t i = 0; i < found.fit().parameters.size(); ++i) {
    if (found.fit().parameters[i].state == ParameterState::identified) {
      told.push_back(i);
    }
  }
  return told;
}

const char* state_word(ParameterState state) {
  constexpr std::array kWords{std::pair{ParameterState::known, "given"},
                              std::pair{ParameterState::identified, "identified"},
                              std::pair{ParameterState::at_bound, "at its bound"}};
  const auto* const found = std::ranges::find(kWords, state, [](const auto& w) { return w.first; });
  return found == kWords.end() ? "not told by the log" : found->second;
}

double half_width90(const FittedParameter& parameter) {
  return kNormal90 * parameter.error;
}

std::string parameter_unit(const study::Identification& found, std::size_t place) {
  if (found.six) {
    return six_axis_unit(found, place);
  }
  constexpr std::array<const char*, PlanarPlace::thrusters> kUnits{
      "kg",        "kg",        "kg m",          "kg m^2", "N s/m", "N s/m", "N m s/rad",
      "N s^2/m^2", "N s^2/m^2", "N m s^2/rad^2", "N",      "N",     "N m"};
  constexpr std::array<const char*, PlanarPlace::thrusters> kRatios{
      "1",   "1",   "m",         "m^2",   "1/s",   "1/s",    "m^2/(rad s)",
      "1/m", "1/m", "m^2/rad^2", "m/s^2", "m/s^2", "m^2/s^2"};
  const bool scaled = found.scale != study::ScaleSource::none;
  if (place < PlanarPlace::thrusters) {
    return scaled ? kUnits[place] : kRatios[place];
  }
  const std::size_t index = (place - PlanarPlace::thrusters) / PlanarPlace::per_thruster;
  switch ((place - PlanarPlace::thrusters) % PlanarPlace::per_thruster) {
    case 2:
      return "rad";
    case 3:
      return "m";
    default:
      break;
  }
  const std::string& unit = found.speed_units[index];
  return fmt::format("{}/({})^2", scaled ? "N" : "m/s^2",
                     unit.empty() ? found.planar.vehicle().thrusters[index].name : unit);
}

std::string parameters_yaml(const study::Identification& found, Frame frame) {
  std::string text = fmt::format(
      "# Parameters of Fossen's equation {}, by `kelpie identify`: docs/howto/identify.md\n"
      "format: {}\nversion: {}\nlog: {}\nframe: {}\ntraining_rows: {}\nsplit: {}\n"
      "scale: {}\nmisfit: {}\n",
      found.six ? "on six axes" : "in the plane", kParametersFormat, kParametersVersion,
      quoted(found.source), found.six || frame == Frame::frd ? "FRD" : "FLU", found.training_rows,
      quoted(found.split), quoted(scale_text(found)), number("{:.3g}", found.fit().misfit));
  if (found.mass_kg) {
    text += fmt::format("mass_kg: {:.6g}\n", *found.mass_kg);
  }
  if (!found.held_out.times_s.empty()) {
    text += "held_out_r2:\n";
    for (std::size_t axis = 0; axis < found.targets.size(); ++axis) {
      text += fmt::format("  {}: {{vehicle: {}, same_terms_untied: {}}}\n",
                          quoted(found.targets[axis]), number("{:.4f}", found.held_out.r2[axis]),
                          number("{:.4f}", found.held_out.free_r2[axis]));
    }
  }
  text += actuators(found);
  text += "parameters:\n";
  for (std::size_t i = 0; i < found.fit().parameters.size(); ++i) {
    text += parameter_line(found, i);
  }
  return text + correlations(found);
}

}  // namespace kelpie::format
