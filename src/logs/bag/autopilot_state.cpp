// SPDX-License-Identifier: Apache-2.0
#include "bag/autopilot_state.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <string_view>

#include "bag/decoding.hpp"
#include "bag/tuning.hpp"
#include "kelpie/core/error.hpp"
#include "wire/scalar.hpp"

namespace kelpie::bag {
namespace {

// ArduPilot, libraries/AP_Logger/LogEvent: ARMED and DISARMED.
constexpr double kEventArmed = 10.0;
constexpr double kEventDisarmed = 11.0;
constexpr unsigned kSafetyArmed = 128;  // MAV_MODE_FLAG_SAFETY_ARMED

// The bytes of a field of a packed layout; none where the message is too short.
std::span<const std::byte> bytes_of_field(const MessageType& type, std::string_view name,
                                          std::span<const std::byte> message) {
  std::size_t at = 0;
  for (const Field& field : type.root.fields) {
    const std::size_t count = field.shape == FieldShape::array ? field.size : 1;
    const std::size_t bytes = field.least_bytes * count;
    if (field.name == name) {
      return at + bytes <= message.size() ? message.subspan(at, bytes)
                                          : std::span<const std::byte>();
    }
    at += bytes;
  }
  return {};
}

// NaN where the message has no such number.
double number_in(const MessageType& type, std::string_view name,
                 std::span<const std::byte> message) {
  const auto field = std::ranges::find(type.root.fields, name, &Field::name);
  const std::span<const std::byte> bytes = bytes_of_field(type, name, message);
  return bytes.empty() || !wire::is_number(field->kind)
             ? std::numeric_limits<double>::quiet_NaN()
             : wire::number_of(field->kind, bytes, std::endian::little);
}

}  // namespace

void keep_parameter(std::map<std::string, double>& parameters, const std::string& name,
                    double value) {
  if (parameters.size() < kTuning.most_parameters || parameters.contains(name)) {
    parameters[name] = value;
  }
}

std::string parameter_told(const Topic& topic, const Message& message) {
  return topic.type == "PARAM_VALUE" && topic.encoding == "mavlink"
             ? mavlink::text_at(*mavlink::find_definition(topic.type)->find("param_id"),
                                message.data)
             : "";
}

AutopilotState::Known AutopilotState::known(const Topic& topic) {
  Known of;
  if (topic.encoding == "mavlink" && topic.name == topic.type) {  // the vehicle's own
    of.kind = topic.type == "HEARTBEAT"     ? Kind::heartbeat
              : topic.type == "PARAM_VALUE" ? Kind::parameter
                                            : Kind::other;
    of.definition = mavlink::find_definition(topic.type);
  } else if (topic.encoding == "dataflash") {
    of.kind = topic.type == "PARM"  ? Kind::parameter
              : topic.type == "ARM" ? Kind::arm
              : topic.type == "EV"  ? Kind::event
                                    : Kind::other;
  }
  if (of.kind != Kind::other && of.definition == nullptr) {
    try {
      of.type = encoding_called(topic.encoding).type_of(topic, MessageDefinitions());
    } catch (const InputError&) {
      of.kind = Kind::other;
    }
  }
  return of;
}

void AutopilotState::hear(const std::vector<Topic>& topics, const Message& message) {
  while (by_topic_.size() < topics.size()) {
    const Topic& topic = topics[by_topic_.size()];
    is_of_mavlink_ = is_of_mavlink_ || topic.encoding == "mavlink";
    by_topic_.push_back(known(topic));
  }
  const Known& of = by_topic_[message.topic];
  if (of.kind == Kind::other) {
    return;
  }
  if (of.definition != nullptr) {
    hear_mavlink(of, message.data);
  } else {
    hear_dataflash(of, message.data);
  }
}

void AutopilotState::hear_mavlink(const Known& of, std::span<const std::byte> message) {
  const mavlink::Definition& definition = *of.definition;
  if (of.kind == Kind::heartbeat) {
    const double mode = mavlink::number_at(*definition.find("base_mode"), message);
    hear_armed((static_cast<unsigned>(mode) & kSafetyArmed) != 0);
  } else {
    keep_parameter(parameters_, mavlink::text_at(*definition.find("param_id"), message),
                   mavlink::number_at(*definition.find("param_value"), message));
  }
}

void AutopilotState::hear_dataflash(const Known& of, std::span<const std::byte> message) {
  if (of.kind == Kind::parameter) {
    const std::string name = wire::text_of(bytes_of_field(of.type, "Name", message));
    const double value = number_in(of.type, "Value", message);
    if (!name.empty()) {
      keep_parameter(parameters_, name, value);
    }
    if (name == "LOG_DISARMED" && value > 0.0 && !is_armed_) {
      hear_armed(false);  // such a log begins before the motors are armed, others with arming
    }
    return;
  }
  const bool is_arm = of.kind == Kind::arm;
  const double value = number_in(of.type, is_arm ? "ArmState" : "Id", message);
  const bool arms = is_arm ? value == 1.0 : value == kEventArmed;
  const bool disarms = is_arm ? value == 0.0 : value == kEventDisarmed;
  if (arms || disarms) {
    was_armed_ = was_armed_ || (disarms && !is_armed_);
    was_disarmed_ = was_disarmed_ || (arms && !is_armed_);
    hear_armed(arms);
  }
}

void AutopilotState::hear_armed(bool is_armed) {
  is_armed_ = is_armed;
  was_armed_ = was_armed_ || is_armed;
  was_disarmed_ = was_disarmed_ || !is_armed;
}

}  // namespace kelpie::bag
