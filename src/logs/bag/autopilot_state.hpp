// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bag/message_type.hpp"
#include "bag/reader.hpp"
#include "mavlink/definition.hpp"

namespace kelpie::bag {

/// Keeps the value of a parameter; of a new name only below Tuning::most_parameters names, so that
/// damaged and hostile messages fill no memory.
void keep_parameter(std::map<std::string, double>& parameters, const std::string& name,
                    double value);

/// Name of the parameter that a PARAM_VALUE of MAVLink tells, of any sender; empty: another
/// message.
std::string parameter_told(const Topic& topic, const Message& message);

/// What an autopilot says of itself: whether its motors are armed, and its parameters. Hears the
/// vehicle's HEARTBEAT and PARAM_VALUE of MAVLink, and ARM, EV and PARM of DataFlash (ArduPilot).
class AutopilotState {
 public:
  /// Hears a message of one of `topics`; messages of other kinds have no effect. Doesn't throw on
  /// data. Allocates for a new topic and for a parameter only.
  void hear(const std::vector<Topic>& topics, const Message& message);

  /// Empty: the autopilot has not said so yet.
  const std::optional<bool>& is_armed() const { return is_armed_; }
  /// Whether motors are disarmed as far as is known: MAVLink tells the state once a second, so
  /// messages before the first HEARTBEAT count as disarmed.
  bool is_disarmed() const { return is_armed_ ? !*is_armed_ : is_of_mavlink_; }
  /// Whether motors were armed, or disarmed, at any time. DataFlash tells changes only: motors were
  /// armed before a first message that says disarmed, and disarmed at the beginning of a log with
  /// LOG_DISARMED.
  bool was_armed() const { return was_armed_; }
  bool was_disarmed() const { return was_disarmed_; }
  /// The last value of each parameter, by name: "SERVO1_FUNCTION".
  const std::map<std::string, double>& parameters() const { return parameters_; }

 private:
  enum class Kind { other, heartbeat, parameter, arm, event };
  struct Known {
    Kind kind = Kind::other;
    const mavlink::Definition* definition = nullptr;  // of MAVLink
    MessageType type{};                               // of DataFlash
  };

  static Known known(const Topic& topic);
  void hear_dataflash(const Known& of, std::span<const std::byte> message);
  void hear_mavlink(const Known& of, std::span<const std::byte> message);
  void hear_armed(bool is_armed);

  std::vector<Known> by_topic_;
  std::optional<bool> is_armed_;
  bool is_of_mavlink_ = false;
  bool was_armed_ = false;
  bool was_disarmed_ = false;
  std::map<std::string, double> parameters_;
};

}  // namespace kelpie::bag
