// SPDX-License-Identifier: Apache-2.0
#include "ros/diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.hpp"

namespace kelpie::ros {
namespace {

using Group = live::HealthGroup;
using Kind = live::HealthKind;

// Texts with an alert stand in the message.
template <typename Of>
void add_values(DiagnosticStatus& status, const Of& of, Group group) {
  for (const live::HealthField<Of>& field : live::health_fields<Of>()) {
    const bool is_message = field.kind == Kind::text && field.alert.rule != live::AlertRule::never;
    if (field.group == group && !field.label.empty() && !is_message) {
      status.values.emplace_back(field.label, live::value_text(field, of));
    }
  }
}

// A signal or topic in one line: "silent, rate/Hz 20, samples 700, late 2"; what is 0 is left out.
template <typename Of>
std::string summary(const Of& of) {
  std::vector<std::string> parts;
  for (const live::HealthField<Of>& field : live::health_fields<Of>()) {
    const bool is_number = field.kind == Kind::count || field.kind == Kind::gauge;
    if (field.kind == Kind::flag && field.value(of) > 0.0) {
      parts.emplace_back(field.label);
    } else if (is_number && (field.kind == Kind::gauge || field.value(of) > 0.0)) {
      parts.push_back(fmt::format("{} {}", field.label, live::value_text(field, of)));
    }
  }
  return join_text(parts, ", ");
}

DiagnosticStatus status_of(Group group, const std::string& name, const std::string& well,
                           const std::vector<live::Alert>& alerts) {
  DiagnosticStatus status{.name = name, .message = well};
  std::vector<std::string> texts;
  for (const live::Alert& alert : alerts) {
    if (alert.group == group && (group != Group::axis || alert.subject == name)) {
      texts.push_back(alert.text);
      status.level = std::max(status.level, alert.level);
    }
  }
  status.message = texts.empty() ? well : join_text(texts, "; ");
  return status;
}

}  // namespace

std::vector<DiagnosticStatus> diagnose(const live::Health& now, const live::Health& before) {
  const std::vector<live::Alert> alerts = live::alerts_of(now, before);
  const live::LearnerHealth& learner = now.learner;
  std::vector<DiagnosticStatus> all;
  const auto add = [&](Group group, const std::string& name, const std::string& well) {
    all.push_back(status_of(group, name, well, alerts));
    add_values(all.back(), now, group);
  };
  add(Group::messages, "messages", "messages come");
  for (const live::TopicHealth& topic : now.topics) {
    all.back().values.emplace_back(topic.name, summary(topic));
  }
  for (const live::SourceHealth& source : now.sources) {
    all.back().values.emplace_back(source.name, summary(source));
  }
  add(Group::learning, "learning", "learning");
  add(Group::vehicle, "vehicle", "no change was found");
  for (const live::ThrusterHealth& thruster : learner.thrusters) {
    all.back().values.emplace_back(
        thruster.name + ", share of its thrust",
        fmt::format("{:.2f} ({:.2f} to {:.2f})", thruster.share, thruster.lower, thruster.upper));
  }
  for (const live::ParameterHealth& parameter : learner.parameters) {
    all.back().values.emplace_back(
        parameter.name,
        fmt::format("{:.4g} (± {:.1f} %)", parameter.value, 100.0 * parameter.interval));
  }
  for (const live::AxisHealth& axis : learner.axes) {
    add(Group::axis, axis.name, axis.status.ready ? "a model is in service" : "no model yet");
    add_values(all.back(), axis, Group::axis);
  }
  add(Group::disk, "disk",
      learner.checkpoints > 0 ? "checkpoints are written" : "no checkpoint was due yet");
  return all;
}

}  // namespace kelpie::ros
