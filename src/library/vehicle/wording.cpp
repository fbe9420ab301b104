// SPDX-License-Identifier: Apache-2.0
#include "kelpie/vehicle/diagnosis.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "vehicle/wording.hpp"

namespace kelpie {
namespace {

constexpr std::array<std::string_view, kCauseKinds> kKinds{
    "thruster", "drag", "load", "force", "sensor_scale", "sensor_bias", "frozen", "all_thrusters"};
constexpr std::array<std::string_view, kFindingStates> kStates{"looking", "named", "ambiguous",
                                                               "none"};

// As many digits as it takes to tell the ends of the interval apart.
int digits_of(const Cause& cause) {
  const double width = cause.upper - cause.lower;
  const double place = width > 0.0 ? std::ceil(-std::log10(width)) + 1.0 : 3.0;
  return static_cast<int>(std::clamp(place, 0.0, 8.0));
}

std::string sized(const Cause& cause) {
  const int digits = digits_of(cause);
  return text_of(cause.size, digits) + " (" + text_of(cause.lower, digits) + " to " +
         text_of(cause.upper, digits) + ")";
}

// Of a thruster that had another share of its nominal thrust `before`; 1: all of it.
std::string share_of_thrust(const Cause& cause, double before) {
  const std::string whose = cause.kind == CauseKind::all_thrusters ? "their" : "its";
  const int digits = 100.0 * (cause.upper - cause.lower) < 2.0 ? 1 : 0;
  const auto percent = [&](double share) { return text_of(100.0 * share, digits); };
  const std::string interval = " (" + percent(cause.lower) + " to " + percent(cause.upper) + " %";
  return before == 1.0 ? percent(cause.size) + " % of " + whose + " thrust" + interval + ")"
                       : percent(cause.size) + " % of its nominal thrust" +
                             (cause.size > before ? " again" : "") + interval + "; before " +
                             text_of(100.0 * std::abs(before), 0) + " %)";
}

std::string changed_text(const Cause& cause, double before, const DiagnosisNames& names) {
  return cause.kind == CauseKind::thruster
             ? cause_column(cause, names) + " gives " + share_of_thrust(cause, before)
             : cause_text(cause, names);
}

// What excites a cause and leaves others alone.
std::string drive_for(const Cause& cause, const DiagnosisNames& names) {
  const std::string column = cause_column(cause, names);
  switch (cause.kind) {
    case CauseKind::thruster:
      return column + " alone";
    case CauseKind::drag:
      return "along the axis of " + column + ", fast, and let it coast";
    case CauseKind::load:
      return "off and brake, again and again";
    case CauseKind::force:
      return "slowly, or not at all";
    case CauseKind::all_thrusters:
      return "each thruster alone, off and on";
    default:
      return column + " fast and slowly, both ways";
  }
}

}  // namespace

std::string text_of(double value, int digits, std::chars_format form) {
  std::array<char, 400> text{};  // the greatest number has 309 digits before the point
  const auto [end, error] = std::to_chars(text.begin(), text.end(), value, form, digits);
  return {text.begin(), end};
}

std::string_view kind_name(CauseKind kind) {
  return kKinds[static_cast<std::size_t>(kind)];
}

std::string_view state_name(FindingState state) {
  return kStates[static_cast<std::size_t>(state)];
}

std::string cause_column(const Cause& cause, const DiagnosisNames& names) {
  switch (cause.kind) {
    case CauseKind::load:
    case CauseKind::all_thrusters:
      return "";
    case CauseKind::drag:
    case CauseKind::force:
      return names.targets[cause.place];
    default:
      return names.inputs[cause.place];
  }
}

std::string cause_text(const Cause& cause, const DiagnosisNames& names) {
  const std::string column = cause_column(cause, names);
  switch (cause.kind) {
    case CauseKind::thruster:
      return column + " gives " + share_of_thrust(cause, 1.0);
    case CauseKind::drag:
      return "the drag in " + column + " is " + sized(cause) + " times what it was";
    case CauseKind::load:
      return "its inertia is " + sized(cause) + " times what it was: a load " +
             (cause.size > 1.0 ? "has come" : "has gone");
    case CauseKind::force:
      return "a constant force adds " + sized(cause) + " to " + column;
    case CauseKind::sensor_scale:
      return column + " reads " + sized(cause) + " times the truth";
    case CauseKind::sensor_bias:
      return column + " reads " + sized(cause) + " too much";
    case CauseKind::frozen:
      return column + " is frozen at " + text_of(cause.size, 4, std::chars_format::general);
    case CauseKind::all_thrusters:
      return "all thrusters give " + share_of_thrust(cause, 1.0);
  }
  return "";
}

std::string finding_text(const Finding& finding, const DiagnosisNames& names) {
  switch (finding.state) {
    case FindingState::looking:
      return "the vehicle has changed; the rows so far don't tell what";
    case FindingState::none:
      return "the vehicle has changed, by none of the causes known nor two of them: the best "
             "explains " +
             text_of(100.0 * finding.explained, 0) + " % of it";
    case FindingState::ambiguous:
      return changed_text(finding.causes[0], finding.before[0], names) + ", or " +
             cause_text(finding.rival, names) + ": not excited enough to tell them apart. Drive " +
             drive_for(finding.causes[0], names) + ", or " + drive_for(finding.rival, names);
    case FindingState::named:
      break;
  }
  std::string text = changed_text(finding.causes[0], finding.before[0], names);
  if (finding.count == 2) {
    text += ", and " + changed_text(finding.causes[1], finding.before[1], names);
  }
  return text;
}

}  // namespace kelpie
