// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "live/health.hpp"

namespace kelpie::live {

/// How an alert and an event call a change of the vehicle.
inline constexpr std::string_view kVehicleChanged = "the vehicle has changed";

/// How an alert and an event call a model that was learned from implausible targets.
inline constexpr std::string_view kModelDoubtful = "the model is doubtful";

/// Type of a field's value.
enum class HealthKind : std::uint8_t { count, gauge, share, flag, text };

/// Part of the run that a field belongs to: a status of its own in ROS diagnostics.
enum class HealthGroup : std::uint8_t { messages, learning, vehicle, axis, disk };

enum class AlertLevel : std::uint8_t { ok, warn, error };  ///< As in diagnostic_msgs.

/// When a field raises its alert.
enum class AlertRule : std::uint8_t {
  never,
  present,  ///< while the value is above the limit, or the text isn't empty
  absent,   ///< while the value is 0
  growing,  ///< while the value grows from one health to the next
};

/// Which changes of an alert the engine reports as an event. The learner reports its own.
enum class AlertEvent : std::uint8_t {
  none,
  first,  ///< a value leaves its limit; a text becomes another
  ended,  ///< the same, and the return
  each,   ///< every growth
};

/// What makes a field's value an alert, and its wording behind the field's subject.
struct AlertSettings {
  AlertRule rule = AlertRule::never;
  AlertLevel level = AlertLevel::ok;
  AlertEvent event = AlertEvent::none;
  std::string_view text{};  ///< "is silent"; empty: the field's own text
  std::string_view end{};   ///< "speaks": what AlertEvent::ended reports
  double limit = 0.0;       ///< of AlertRule::present
};

/// Reads a field: a number (NaN: unknown) or a text; the other function is null.
template <typename Of>
struct HealthValue {
  constexpr HealthValue(double (*read)(const Of&)) : number(read) {}     // NOLINT: for the tables
  constexpr HealthValue(std::string (*read)(const Of&)) : text(read) {}  // NOLINT: the same

  double (*number)(const Of&) = nullptr;
  std::string (*text)(const Of&) = nullptr;
};

/// Names that few fields have.
struct HealthNames {
  std::string_view old_key{};                              ///< JSON key until the next version
  std::string_view old_metric{};                           ///< the same in Prometheus
  std::pair<std::string_view, std::string_view> series{};  ///< further label of the metric
  std::string_view brief{};                                ///< in MAVLink, at most 10 letters
};

/// One number or text of a health. All renderers loop over the fields: a new number is a member of
/// its struct, filled in by its counter, and a line in health_table.cpp. An empty name leaves the
/// field out of the renderer concerned.
template <typename Of>
struct HealthField {
  std::string_view key;     ///< in JSON; fields with the same key, in a row, form an array
  std::string_view metric;  ///< in Prometheus behind "kelpie_": SI units; "_total": a counter
  std::string_view label;   ///< in ROS diagnostics and on the page, "quantity/unit"
  std::string_view unit;    ///< of the number
  HealthKind kind;
  HealthGroup group;
  std::string_view help;  ///< one line, which reads well behind a count
  HealthValue<Of> get;
  AlertSettings alert{};
  HealthNames names{};

  /// The number; of a text 1 unless empty.
  double value(const Of& of) const {
    return get.text == nullptr ? get.number(of) : get.text(of).empty() ? 0.0 : 1.0;
  }
  /// The same in SI units.
  double metric_value(const Of& of) const { return unit == "ms" ? value(of) / 1e3 : value(of); }
};

/// Fields of `Of`: Health (the whole run), AxisHealth, SourceHealth, TopicHealth, ThrusterHealth,
/// VelocityHealth, ParameterHealth.
template <typename Of>
std::span<const HealthField<Of>> health_fields();
template <>
std::span<const HealthField<Health>> health_fields();
template <>
std::span<const HealthField<AxisHealth>> health_fields();
template <>
std::span<const HealthField<SourceHealth>> health_fields();
template <>
std::span<const HealthField<TopicHealth>> health_fields();
template <>
std::span<const HealthField<ThrusterHealth>> health_fields();
template <>
std::span<const HealthField<VelocityHealth>> health_fields();
template <>
std::span<const HealthField<ParameterHealth>> health_fields();

/// Calls `visit(list, name)` for each list of a health: axes, signals, topics, thrusters,
/// velocities, parameters.
template <typename Visit>
void visit_health_lists(const Health& health, Visit visit) {
  visit(health.learner.axes, "axis");
  visit(health.sources, "signal");
  visit(health.topics, "topic");
  visit(health.learner.thrusters, "thruster");
  visit(health.reckoning.velocities, "velocity");
  visit(health.learner.parameters, "parameter");
}

/// Something that is wrong now.
struct Alert {
  HealthGroup group;
  AlertLevel level;
  std::string_view key;  ///< of the field; empty: a fault of the transport
  std::string subject;   ///< name of the axis, signal or topic; empty: the whole run
  std::string text;      ///< whole, with the subject
};

/// All alerts, errors first. `before` is the previous health: only growth since then counts.
std::vector<Alert> alerts_of(const Health& now, const Health& before);

/// Lines to report to the outputs since `before`.
std::vector<std::string> events_of(const Health& now, const Health& before);

/// A number for people: "12", "0.25", "yes", "unknown".
std::string health_text(HealthKind kind, double value);

/// Value of a field: its text, or its number by health_text().
template <typename Of>
std::string value_text(const HealthField<Of>& field, const Of& of) {
  return field.get.text != nullptr ? field.get.text(of)
                                   : health_text(field.kind, field.get.number(of));
}

}  // namespace kelpie::live
