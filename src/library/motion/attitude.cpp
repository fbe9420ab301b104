// SPDX-License-Identifier: Apache-2.0
#include "kelpie/motion/attitude.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "core/angle.hpp"
#include "core/text.hpp"
#include "kelpie/motion/term_set.hpp"
#include "motion/states.hpp"

namespace kelpie {
namespace {

constexpr double kToUnitLength = 1.0;  // 1/s, return of a quaternion to unit length
constexpr double kLeastCosine = 0.1;   // of pitch: roll is lost at a right angle

constexpr std::array kRollNames = std::to_array<std::string_view>({"roll", "phi", "heel"});
constexpr std::array kPitchNames = std::to_array<std::string_view>({"pitch", "theta", "trim"});
constexpr std::array kHeadingNames =
    std::to_array<std::string_view>({"yaw", "psi", "heading", "course", "cog", "hdg"});
constexpr std::array kDegreeEndings =
    std::to_array<std::string_view>({"_deg", "_degrees", "_degree"});
constexpr std::array kAngleEndings =
    std::to_array<std::string_view>({"_rad", "_radians", "_angle"});
// Words within names of messages whose fields are no angles of the vehicle, and those that only
// begin a word: an aircraft has no "rc", a level no "vel".
constexpr std::array kOtherMessages = std::to_array<std::string_view>(
    {"command", "control", "setpoint", "desired", "target", "twist"});
constexpr std::array kOtherWords =
    std::to_array<std::string_view>({"cmd", "rate", "vel", "input", "joy"});
constexpr std::array<std::string_view, 4> kQuaternion{"x", "y", "z", "w"};
constexpr std::array kQuaternionBefore = std::to_array<std::string_view>(
    {"q", "q_", "quat_", "quaternion_", "orientation_", "orientation.", "quaternion.", "quat."});

std::string lower_case(std::string_view name) {
  std::string text(name);
  std::ranges::transform(text, text.begin(), [](unsigned char letter) {
    return letter == '/' ? '.' : static_cast<char>(std::tolower(letter));
  });
  return text;
}

bool remove_ending(std::string& word, std::span<const std::string_view> endings) {
  for (const std::string_view ending : endings) {
    if (word.ends_with(ending)) {
      word.resize(word.size() - ending.size());
      return true;
    }
  }
  return false;
}

bool is_other_message(std::string message) {
  if (std::ranges::any_of(kOtherMessages, [&](std::string_view word) {
        return message.find(word) != std::string::npos;
      })) {
    return true;
  }
  std::ranges::replace(message, '_', '.');
  return std::ranges::any_of(split_text(message, '.'), [](const std::string& part) {
    return part == "rc" || std::ranges::any_of(kOtherWords, [&](std::string_view word) {
             return part.starts_with(word);
           });
  });
}

void find_angle(std::string_view name, std::size_t input, bool degrees, Attitude& found) {
  const std::string text = lower_case(name);
  const std::size_t last = text.find_last_of('.');
  const std::string message = last == std::string::npos ? "" : text.substr(0, last);
  if (is_other_message(message)) {
    return;
  }
  std::string word = text.substr(last + 1);
  const double unit = remove_ending(word, kDegreeEndings) || degrees ? kRadPerDegree : 1.0;
  remove_ending(word, kAngleEndings);
  if (std::ranges::find(kHeadingNames, word) != kHeadingNames.end()) {
    found.headings.push_back(input);
  } else if (!found.roll && std::ranges::find(kRollNames, word) != kRollNames.end()) {
    found.roll = input;
    found.roll_unit = unit;
  } else if (!found.pitch && std::ranges::find(kPitchNames, word) != kPitchNames.end()) {
    found.pitch = input;
    found.pitch_unit = unit;
  }
}

std::optional<std::array<std::size_t, 4>> find_quaternion(std::span<const std::string> names) {
  const auto place_of = [&](std::string_view ending, std::string_view before) {
    return std::ranges::find_if(names, [&](const std::string& name) {
      const std::string text = lower_case(name);
      const std::string wanted = std::string(before) + std::string(ending);
      return text == wanted || (before.ends_with('.') && text.ends_with("." + wanted));
    });
  };
  for (const std::string_view before : kQuaternionBefore) {
    std::array<std::size_t, 4> places{};
    std::size_t known = 0;
    for (const std::string_view ending : kQuaternion) {
      const auto found = place_of(ending, before);
      if (found != names.end()) {
        places[known++] = static_cast<std::size_t>(found - names.begin());
      }
    }
    if (known == places.size()) {
      return places;
    }
  }
  return std::nullopt;
}

}  // namespace

bool Attitude::contains(std::size_t input) const {
  const auto among = [input](const auto& list) {
    return std::ranges::find(list, input) != list.end();
  };
  return roll == input || pitch == input || among(headings) || (quaternion && among(*quaternion));
}

Attitude find_attitude(std::span<const std::string> inputs, bool degrees) {
  Attitude found;
  found.quaternion = find_quaternion(inputs);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    find_angle(inputs[i], i, degrees, found);
  }
  return found;
}

Attitude attitude_for(std::string_view terms, std::span<const std::string> inputs) {
  const std::string_view setting = trimmed(terms);
  return setting == "quadratic" ? Attitude{}
                                : find_attitude(inputs, setting == TermSet::kAutoDegrees);
}

AttitudeMotion::AttitudeMotion(const Attitude& attitude, std::span<const std::string> inputs,
                               std::span<const std::size_t> states)
    : attitude_(attitude) {
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const std::optional<std::size_t> axis = velocity_axis(inputs[i]);
    if (axis && *axis >= 3 && !turning_[*axis - 3]) {
      turning_[*axis - 3] = i;
    }
  }
  const auto integrated = [&](const std::optional<std::size_t>& turning) {
    return turning && std::ranges::find(states, *turning) != states.end();
  };
  if (attitude.quaternion && std::ranges::all_of(turning_, integrated)) {
    inputs_.assign(attitude.quaternion->begin(), attitude.quaternion->end());
  } else if (!attitude.quaternion) {
    for (const auto& [angle, turning] :
         {std::pair{attitude.roll, turning_[0]}, std::pair{attitude.pitch, turning_[1]}}) {
      if (angle && integrated(turning)) {
        inputs_.push_back(*angle);
      }
    }
  }
}

void AttitudeMotion::rates(std::span<const double> x, std::span<double> rates) const {
  if (inputs_.empty()) {
    return;
  }
  const auto turning = [&](std::size_t axis) { return turning_[axis] ? x[*turning_[axis]] : 0.0; };
  const double p = turning(0);
  const double q = turning(1);
  const double r = turning(2);
  if (attitude_.quaternion) {
    const auto [i, j, k, l] = *attitude_.quaternion;
    const double a = x[i];
    const double b = x[j];
    const double c = x[k];
    const double w = x[l];
    const double back = kToUnitLength * (1.0 - a * a - b * b - c * c - w * w);
    rates[0] = 0.5 * (w * p - c * q + b * r) + back * a;
    rates[1] = 0.5 * (c * p + w * q - a * r) + back * b;
    rates[2] = 0.5 * (-b * p + a * q + w * r) + back * c;
    rates[3] = -0.5 * (a * p + b * q + c * r) + back * w;
    return;
  }
  const double roll = attitude_.roll ? attitude_.roll_unit * x[*attitude_.roll] : 0.0;
  const double pitch = attitude_.pitch ? attitude_.pitch_unit * x[*attitude_.pitch] : 0.0;
  const double upright =
      std::copysign(std::max(std::abs(std::cos(pitch)), kLeastCosine), std::cos(pitch));
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    rates[i] = inputs_[i] == attitude_.roll
                   ? (p + (q * std::sin(roll) + r * std::cos(roll)) * std::sin(pitch) / upright) /
                         attitude_.roll_unit
                   : (q * std::cos(roll) - r * std::sin(roll)) / attitude_.pitch_unit;
  }
}

AngleUnit unit_of_angles(const Attitude& attitude, std::span<const double> largest) {
  constexpr double kRounding = 1.01;
  const auto within = [&](double pitch, double roll) {
    return (!attitude.pitch || largest[*attitude.pitch] <= kRounding * pitch) &&
           (!attitude.roll || largest[*attitude.roll] <= kRounding * roll);
  };
  if (within(std::numbers::pi / 2.0, kFullTurn)) {
    return AngleUnit::radians;
  }
  return within(90.0, 360.0) ? AngleUnit::degrees : AngleUnit::none;
}

}  // namespace kelpie
