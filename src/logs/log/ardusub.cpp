// SPDX-License-Identifier: Apache-2.0
#include "log/ardusub.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "core/text.hpp"
#include "motion/signal_names.hpp"

namespace kelpie::log {
namespace {

constexpr std::size_t kMostOutputs = 32;

// SERVOn_FUNCTION (ArduPilot, SRV_Channel.h).
struct FunctionRange {
  int first;
  int last;
  std::string_view use;  // "#": numbered from `number`
  int number = 1;
};
constexpr std::array kMotorFunctions =
    std::to_array<FunctionRange>({{33, 40, "motor", 1}, {82, 85, "motor", 9}});
constexpr std::array kOtherFunctions = std::to_array<FunctionRange>({{6, 8, "camera mount"},
                                                                     {10, 10, "camera trigger"},
                                                                     {28, 28, "gripper"},
                                                                     {51, 66, "RC input #"},
                                                                     {181, 182, "lights #"}});

// FRAME_CONFIG (ArduSub, AP_Motors6DOF.h).
constexpr std::array<std::string_view, 7> kFrames{
    "BlueROV1, 6 motors",
    "vectored, 6 motors (BlueROV2)",
    "vectored 6DOF, 8 motors (BlueROV2 Heavy)",
    "vectored 6DOF 90°, 8 motors",
    "SimpleROV-3, 3 motors",
    "SimpleROV-4, 4 motors",
    "SimpleROV-5, 5 motors",
};

double parameter(const ParameterMap& parameters, const std::string& name, double otherwise) {
  const auto found = parameters.find(name);
  return found == parameters.end() || !std::isfinite(found->second) ? otherwise : found->second;
}

int function_of(const ParameterMap& parameters, std::size_t output) {
  return static_cast<int>(parameter(parameters, fmt::format("SERVO{}_FUNCTION", output), 0.0));
}

const FunctionRange* range_of(std::span<const FunctionRange> ranges, int function) {
  const auto found = std::ranges::find_if(ranges, [&](const FunctionRange& range) {
    return range.first <= function && function <= range.last;
  });
  return found == ranges.end() ? nullptr : &*found;
}

}  // namespace

std::vector<MotorActuator> motor_outputs(const ParameterMap& parameters) {
  std::vector<MotorActuator> outputs;
  for (std::size_t output = 1; output <= kMostOutputs; ++output) {
    const int function = function_of(parameters, output);
    if (const FunctionRange* const range = range_of(kMotorFunctions, function)) {
      const auto motor = static_cast<std::size_t>(range->number + function - range->first);
      const double direction = parameter(parameters, fmt::format("MOT_{}_DIRECTION", motor), 1.0);
      outputs.push_back({output, motor, direction < 0.0 ? -1.0 : 1.0});
    }
  }
  std::ranges::stable_sort(outputs, {}, &MotorActuator::motor);
  return outputs;
}

std::size_t output_of(std::string_view column) {
  const std::size_t colon = std::min(column.rfind(':'), column.size());
  const std::string_view topic = column.substr(0, colon);
  const std::string_view kind = topic.substr(topic.rfind('/') + 1);
  if (kind != "SERVO_OUTPUT_RAW" && kind != "RCOU") {
    return 0;
  }
  const std::size_t digit = std::min(column.find_first_of("0123456789", colon), column.size());
  return std::strtoul(std::string(column.substr(digit)).c_str(), nullptr, 10);
}

std::string next_parameter(const ParameterMap& parameters, std::size_t output) {
  const std::string function = fmt::format("SERVO{}_FUNCTION", output);
  if (!parameters.contains(function)) {
    return function;
  }
  for (const MotorActuator& motor : motor_outputs(parameters)) {
    const std::string direction = fmt::format("MOT_{}_DIRECTION", motor.motor);
    if (motor.output == output && !parameters.contains(direction)) {
      return direction;
    }
  }
  return "";
}

std::optional<double> pulse_factor(const ParameterMap& parameters, std::size_t output) {
  if (!next_parameter(parameters, output).empty()) {
    return std::nullopt;
  }
  for (const MotorActuator& motor : motor_outputs(parameters)) {
    if (motor.output == output) {
      return motor.direction;
    }
  }
  return 1.0;
}

double mirrored(double pulse_us, double factor) {
  return kNeutralPulseUs + factor * (pulse_us - kNeutralPulseUs);
}

std::string other_outputs_text(const ParameterMap& parameters) {
  std::vector<std::string> texts;
  for (std::size_t output = 1; output <= kMostOutputs; ++output) {
    const int function = function_of(parameters, output);
    if (function <= 0 || range_of(kMotorFunctions, function) != nullptr) {
      continue;
    }
    const FunctionRange* const range = range_of(kOtherFunctions, function);
    std::string use =
        range == nullptr ? fmt::format("function {}", function) : std::string(range->use);
    if (use.ends_with('#')) {
      use = use.substr(0, use.size() - 1) + std::to_string(range->number + function - range->first);
    }
    texts.push_back(fmt::format("{} ({})", output, use));
  }
  return join_text(texts, ", ");
}

std::string sub_frame_name(const ParameterMap& parameters) {
  const double frame = parameter(parameters, "FRAME_CONFIG", -1.0);
  return frame < 0.0 || frame >= static_cast<double>(kFrames.size())
             ? ""
             : std::string(kFrames[static_cast<std::size_t>(frame)]);
}

}  // namespace kelpie::log
