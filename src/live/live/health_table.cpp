// SPDX-License-Identifier: Apache-2.0
#include "live/health_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>

#include "live/tuning.hpp"

namespace kelpie::live {
namespace {

template <typename Of, auto... kPath>
double number_at(const Of& of) {
  return static_cast<double>((of.*....*kPath));
}

template <typename Of, auto... kPath>
std::string text_at(const Of& of) {
  return (of.*....*kPath);
}

double thrusters_watched(const Health& health) {
  return static_cast<double>(health.learner.thrusters.size());
}

// NaN where no parameter is asked for.
double parameters_known(const Health& health) {
  const LearnerHealth& learner = health.learner;
  return learner.countdown.empty() ? std::nan("") : static_cast<double>(learner.parameters_known);
}

double parameters_asked(const Health& health) {
  const LearnerHealth& learner = health.learner;
  return learner.countdown.empty() ? std::nan("") : static_cast<double>(learner.parameters.size());
}

std::string commands_text(const Health& health) {
  return health.learner.alignment.text();
}

double is_silent(const SourceHealth& source) {
  return source.is_silent() ? 1.0 : 0.0;
}

template <auto... kPath>
constexpr auto run = number_at<Health, kPath...>;
template <auto kMember>
constexpr auto transport = number_at<Health, &Health::transport, kMember>;
template <auto kMember>
constexpr auto learner = number_at<Health, &Health::learner, kMember>;
template <auto... kPath>
constexpr auto of_axis = number_at<AxisHealth, kPath...>;
template <auto kMember>
constexpr auto tally = number_at<AxisHealth, &AxisHealth::status, &Status::tally, kMember>;
template <auto... kPath>
constexpr auto of_signal = number_at<SourceHealth, kPath...>;
template <auto kMember>
constexpr auto of_topic = number_at<TopicHealth, kMember>;
template <auto kMember>
constexpr auto of_thruster = number_at<ThrusterHealth, kMember>;
template <auto kMember>
constexpr auto reckoning = number_at<Health, &Health::reckoning, kMember>;
template <auto kMember>
constexpr auto of_velocity = number_at<VelocityHealth, kMember>;
template <auto kMember>
constexpr auto of_parameter = number_at<ParameterHealth, kMember>;
template <auto kMember>
constexpr auto faults = number_at<SourceHealth, &SourceHealth::faults, kMember>;

double is_ready(const Health& health) {
  return std::ranges::any_of(health.learner.axes,
                             [](const AxisHealth& one) { return one.status.ready; })
             ? 1.0
             : 0.0;
}

double checkpoint_age_s(const Health& health) {
  const LearnerHealth& learner = health.learner;
  // Less than 0 after a clock was set back.
  return learner.checkpoints > 0 ? std::max(0.0, learner.last_t_s - learner.checkpoint_t_s)
                                 : std::nan("");
}

// Short names for the tables alone: this source may be compiled together with others.
namespace tables {

using enum HealthKind;
using enum HealthGroup;
using enum AlertRule;
using enum AlertLevel;

constexpr AlertSettings alert(AlertRule rule, AlertLevel level = ok,
                              AlertEvent event = AlertEvent::none, std::string_view text = {},
                              std::string_view end = {}, double limit = 0.0) {
  return {rule, level, event, text, end, limit};
}

constexpr HealthNames series(std::string_view label, std::string_view value) {
  return {.series = {label, value}};
}

constexpr HealthNames brief(std::string_view name) {
  return {.brief = name};
}

constexpr HealthNames old_key(std::string_view key, std::string_view metric = {},
                              std::string_view brief = {}) {
  return {.old_key = key, .old_metric = metric, .brief = brief};
}

constexpr std::array kRun = std::to_array<HealthField<Health>>({
    {"idle_s", "idle_seconds", "no message for/s", "s", gauge, messages,
     "time since the last message", run<&Health::idle_s>,
     alert(present, error, AlertEvent::first, "no messages come", "", kTuning.longest_idle_s)},
    {"lost", "messages_lost_total", "messages lost", "", count, messages,
     "messages lost on their way", transport<&TransportHealth::lost>,
     alert(growing, warn, AlertEvent::first, "messages are lost"), brief("msgs_lost")},
    {"damaged", "messages_damaged_total", "frames damaged", "", count, messages,
     "frames and packets that cannot be read", transport<&TransportHealth::damaged>},
    {"unknown", "messages_unknown_total", "messages unknown", "", count, messages,
     "messages without a definition", transport<&TransportHealth::unknown>},
    {"refused", "messages_refused_total", "messages refused", "", count, messages,
     "messages of a second sender under the same numbers, or without a right signature",
     transport<&TransportHealth::refused>,
     alert(growing, warn, AlertEvent::first, "messages are refused")},
    {"clock_restarts", "clock_restarts_total", "clock set back", "", count, messages,
     "times a clock was set back", run<&Health::clock_restarts>,
     alert(growing, warn, AlertEvent::each, "a clock was set back; samples begin anew")},
    {"velocity_silent_s", "velocity_silent_seconds", "velocity not measured for/s", "s", gauge,
     messages, "time since the velocity log measured a velocity; meanwhile velocities are reckoned",
     reckoning<&ReckoningHealth::silent_s>},
    {"velocity_fault", "velocity_lost", "no measured velocity", "", text, messages,
     "why the velocity log isn't used at present",
     text_at<Health, &Health::reckoning, &ReckoningHealth::fault>, alert(present, warn)},
    {"velocity_outages", "velocity_outages_total", "outages of velocity", "", count, messages,
     "outages of the velocity log that have ended", reckoning<&ReckoningHealth::outages>},
    {"velocity_longest_s", "velocity_longest_outage_seconds", "longest outage/s", "s", gauge,
     messages, "the longest of the outages that have ended",
     reckoning<&ReckoningHealth::longest_s>},
    {"velocity_step", "velocity_largest_step", "largest step of velocity/σ", "", gauge, messages,
     "largest step of a velocity at a measurement, in standard deviations",
     reckoning<&ReckoningHealth::largest_step>},
    {"current_speed", "current_speed", "current/(m/s)", "m/s", gauge, messages,
     "speed of the water over ground, of vehicles in the plane; 0: none was found",
     reckoning<&ReckoningHealth::current_speed>},
    {"current_direction", "current_direction_degrees", "current towards/°", "°", gauge, messages,
     "where the water goes, as a reading of the heading",
     reckoning<&ReckoningHealth::current_direction>},
    {"t", "row_time_seconds", "last row/s", "s", gauge, learning,
     "time of the last row since the origin, by the vehicle's clock",
     learner<&LearnerHealth::last_t_s>},
    {"rows", "rows_total", "rows", "", count, learning, "rows made of messages",
     run<&Health::rows>},
    {"incomplete", "rows_incomplete_total", "rows incomplete", "", count, learning,
     "rows with a value missing, not learned", run<&Health::rows_incomplete>},
    {"no_rows", "rows_missing", "nothing to learn", "", text, learning,
     "why there has been no whole row for long", text_at<Health, &Health::no_rows>,
     alert(present, warn, AlertEvent::ended, "", "rows are whole again")},
    {"row_late_s", "row_late_seconds", "rows come late by/s", "s", gauge, learning,
     "from a row's time to the message that completes the row: half a window of poses or of a "
     "centred derivative, and more",
     run<&Health::row_late_s>},
    {"rows_paused", "rows_paused_total", "rows while frozen", "", count, learning,
     "rows while learning was frozen, not learned", learner<&LearnerHealth::rows_paused>,
     alert(never), old_key("paused")},
    {"rows_stuck", "rows_stuck_total", "rows stuck", "", count, learning,
     "rows with a stuck velocity, not learned", learner<&LearnerHealth::rows_stuck>,
     alert(growing, warn, AlertEvent::none, "rows with a stuck velocity aren't learned"),
     old_key("stuck")},
    {"dropped", "rows_dropped_total", "rows lost", "", count, learning,
     "rows lost, the learner was behind", run<&Health::rows_dropped>,
     alert(growing, error, AlertEvent::first, "the learner is behind: rows are lost"),
     brief("rows_lost")},
    {"waiting", "rows_waiting", "rows waiting", "", count, learning,
     "rows that wait for the learner", run<&Health::rows_waiting>},
    {"learned", "samples_learned", "samples learned", "", count, learning,
     "samples learned, those of earlier starts too", learner<&LearnerHealth::learned>, alert(never),
     brief("learned")},
    {"learning_paused", "learning_paused", "learning frozen", "", flag, learning,
     "learning is frozen by request", learner<&LearnerHealth::is_paused>,
     alert(present, warn, AlertEvent::none, "learning is frozen, as was asked"),
     old_key("frozen", "learning_frozen", "frozen")},
    {"ready", "model_ready", "model in service", "", flag, learning, "a model is in service",
     is_ready, alert(absent, warn, AlertEvent::none, "no model yet")},
    {"doubt", "model_doubtful", "model doubtful", "", text, learning,
     "what cannot be right in the learned targets",
     text_at<Health, &Health::learner, &LearnerHealth::doubt>,
     alert(present, error, AlertEvent::none, kModelDoubtful)},
    {"commands", "", "commands", "", text, learning, "shift and actuators of the commands",
     commands_text},
    {"shift_s", "command_shift_seconds", "", "s", gauge, learning,
     "shift of the commands, to later times",
     run<&Health::learner, &LearnerHealth::alignment, &Alignment::lag_s>},
    {"delay_ms", "row_delay_median_seconds", "delay/ms, median", "ms", gauge, learning,
     "from a row's last message until the row is learned, median",
     learner<&LearnerHealth::median_delay_ms>, alert(never), brief("delay_ms")},
    {"delay_ms", "row_delay_longest_seconds", "delay/ms, longest", "ms", gauge, learning,
     "from a row's last message until the row is learned, longest of the last rows",
     learner<&LearnerHealth::longest_delay_ms>},
    {"vehicle", "vehicle_changed", "change found", "", text, vehicle,
     "the last change of the vehicle, and its cause",
     text_at<Health, &Health::learner, &LearnerHealth::vehicle>, alert(present, warn)},
    {"thrusters_watched", "thrusters_watched", "thrusters watched", "", count, vehicle,
     "thrusters whose share of thrust is known", thrusters_watched},
    {"countdown", "", "parameters known", "", text, vehicle,
     "how many parameters are known as well as was asked, and the one known least",
     text_at<Health, &Health::learner, &LearnerHealth::countdown>},
    {"parameters_known", "parameters_known", "", "", count, vehicle,
     "parameters known as well as was asked", parameters_known, alert(never), brief("par_known")},
    {"parameters_asked", "parameters_asked", "", "", count, vehicle,
     "parameters that are to be told; 0 before the first identification", parameters_asked,
     alert(never), brief("par_asked")},
    {"authority", "authority_lost", "authority left", "", text, vehicle,
     "what the thrusters can still do, where that is less than before",
     text_at<Health, &Health::learner, &LearnerHealth::authority>, alert(present, warn)},
    {"held_current", "held_current", "holds a current of", "", gauge, vehicle,
     "fastest water from ahead in which the vehicle holds its place, in the log's unit",
     learner<&LearnerHealth::held_current>},
    {"checkpoints", "checkpoints_total", "checkpoints", "", count, disk, "checkpoints written",
     learner<&LearnerHealth::checkpoints>},
    {"checkpoints_failed", "checkpoints_failed_total", "checkpoints failed", "", count, disk,
     "checkpoints that couldn't be written", learner<&LearnerHealth::checkpoints_failed>},
    {"checkpoint_t", "checkpoint_time_seconds", "", "s", gauge, disk,
     "last row in the newest checkpoint, as kelpie_row_time_seconds",
     learner<&LearnerHealth::checkpoint_t_s>},
    {"checkpoint_age_s", "checkpoint_age_seconds", "age of the checkpoint/s", "s", gauge, disk,
     "from the last row in the newest checkpoint to the last row", checkpoint_age_s},
    {"checkpoint_error", "checkpoint_failing", "no checkpoint", "", text, disk,
     "why the last checkpoint failed",
     text_at<Health, &Health::learner, &LearnerHealth::checkpoint_error>,
     alert(present, error, AlertEvent::none, "no checkpoint can be written")},
    {"record_error", "recording_failed", "no recording", "", text, disk, "why nothing is recorded",
     text_at<Health, &Health::record_error>,
     alert(present, warn, AlertEvent::ended, "nothing can be recorded", "recording goes on")},
    {"unrecorded", "messages_unrecorded_total", "messages not recorded", "", count, disk,
     "messages not recorded, the disk took no more", run<&Health::unrecorded>},
});

constexpr std::array kAxis = std::to_array<HealthField<AxisHealth>>({
    {"r2", "axis_r2", "R² of late", "", gauge, axis, "R2 one step ahead, over the last samples",
     of_axis<&AxisHealth::r2>, alert(never), series("predictor", "model")},
    {"r2", "axis_r2", "R² of least squares", "", gauge, axis,
     "R2 of least squares on the same samples", of_axis<&AxisHealth::r2_least_squares>,
     alert(never), series("predictor", "least_squares")},
    {"r2", "axis_r2", "R² of the mean", "", gauge, axis, "R2 of the mean so far",
     of_axis<&AxisHealth::r2_mean>, alert(never), series("predictor", "mean")},
    {"r2", "axis_r2", "R² of the last value", "", gauge, axis, "R2 of the sample before",
     of_axis<&AxisHealth::r2_last_value>, alert(never), series("predictor", "last_value")},
    {"coverage", "axis_coverage_ratio", "inside interval", "", share, axis,
     "share of the last samples inside their interval", of_axis<&AxisHealth::coverage>},
    {"disturbance", "axis_disturbance", "disturbance", "", gauge, axis,
     "what the present disturbance adds, in the target's unit", of_axis<&AxisHealth::disturbance>},
    {"authority", "axis_authority", "authority left", "", share, axis,
     "share of the nominal range of accelerations that the thrusters can give",
     of_axis<&AxisHealth::authority>},
    {"judged", "axis_scored_samples", "samples scored", "", count, axis,
     "samples behind R2 and coverage", of_axis<&AxisHealth::judged>},
    {"ready", "axis_ready", "", "", flag, axis, "a model is in service",
     of_axis<&AxisHealth::status, &Status::ready>},
    {"buffer", "axis_buffer_samples", "buffer", "", count, axis, "samples that the model keeps",
     of_axis<&AxisHealth::status, &Status::buffer>},
    {"support_vectors", "axis_support_vectors", "support vectors", "", count, axis,
     "support vectors of the model", of_axis<&AxisHealth::status, &Status::support_vectors>},
    {"changes", "axis_changes_total", "changes", "", count, axis,
     "changes of the vehicle that were found", tally<&Tally::changes>,
     alert(growing, warn, AlertEvent::none, kVehicleChanged)},
    {"withdrawn", "axis_withdrawn_total", "withdrawn", "", count, axis,
     "changes that were withdrawn", tally<&Tally::withdrawn>},
    {"outliers", "axis_outliers_total", "outliers", "", count, axis,
     "samples that left the buffer as outliers", tally<&Tally::outliers>},
    {"implausible", "axis_implausible_total", "implausible", "", count, axis,
     "samples rejected as implausible", tally<&Tally::implausible>},
});

// The page and the console have report::faults_text() for the faults.
constexpr std::array kSignal = std::to_array<HealthField<SourceHealth>>({
    {"rate_hz", "signal_rate_hertz", "rate/Hz", "Hz", gauge, messages,
     "samples per second of the vehicle's clock", of_signal<&SourceHealth::rate_hz>},
    {"silent_s", "signal_silent_seconds", "silent for/s", "s", gauge, messages,
     "time since the last sample", of_signal<&SourceHealth::silent_s>},
    {"is_silent", "signal_silent", "silent", "", flag, messages,
     "silent for longer than the gap of [log]", is_silent,
     alert(present, warn, AlertEvent::ended, "is silent", "speaks")},
    {"is_stuck", "signal_stuck", "stuck", "", flag, messages,
     "constant for longer than the gap of [log]", of_signal<&SourceHealth::is_stuck>,
     alert(present, warn, AlertEvent::none, "doesn't change any more"), old_key("stuck")},
    {"samples", "signal_samples_total", "samples", "", count, messages, "samples in use",
     faults<&SignalFaults::samples>},
    {"", "signal_faults_total", "without a value", "", count, messages,
     "faults of a signal, by kind", faults<&SignalFaults::no_value>, alert(never),
     series("kind", "no_value")},
    {"", "signal_faults_total", "without a time", "", count, messages, "samples without a time",
     faults<&SignalFaults::no_stamp>, alert(never), series("kind", "no_stamp")},
    {"", "signal_faults_total", "with the stamp before", "", count, messages,
     "samples with the stamp before", faults<&SignalFaults::duplicates>, alert(never),
     series("kind", "duplicate")},
    {"", "signal_faults_total", "late", "", count, messages, "samples too late to be used",
     faults<&SignalFaults::late>, alert(never), series("kind", "late")},
    {"", "signal_faults_total", "out of order", "", count, messages,
     "samples put into the order of time", faults<&SignalFaults::steps_back>, alert(never),
     series("kind", "out_of_order")},
    {"", "signal_faults_total", "silences", "", count, messages,
     "silences longer than the gap of [log]", faults<&SignalFaults::gaps>, alert(never),
     series("kind", "silence")},
    {"", "signal_faults_total", "stretches of one value", "", count, messages,
     "stretches of one value", faults<&SignalFaults::stuck>, alert(never), series("kind", "stuck")},
});

constexpr std::array kTopic = std::to_array<HealthField<TopicHealth>>({
    {"messages", "topic_messages_total", "messages", "", count, messages, "messages received",
     of_topic<&TopicHealth::messages>},
    {"undecodable", "topic_undecodable_total", "not of its type", "", count, messages,
     "messages that aren't of their topic's type", of_topic<&TopicHealth::undecodable>,
     alert(growing, warn, AlertEvent::first, "has messages that aren't of its type")},
    {"refused", "topic_refused", "refused", "", text, messages,
     "why messages of this type cannot be used", text_at<TopicHealth, &TopicHealth::refused>,
     alert(present, error, AlertEvent::first, "cannot be used")},
    {"error", "", "", "", text, messages, "the last message that isn't of its type",
     text_at<TopicHealth, &TopicHealth::last_error>},
});

constexpr std::array kThruster = std::to_array<HealthField<ThrusterHealth>>({
    {"share", "thruster_share", "share of its thrust", "", share, vehicle,
     "share of its thrust that a thruster gives", of_thruster<&ThrusterHealth::share>, alert(never),
     series("bound", "estimate")},
    {"lower", "thruster_share", "lower bound", "", share, vehicle, "lower bound of the share",
     of_thruster<&ThrusterHealth::lower>, alert(never), series("bound", "lower")},
    {"upper", "thruster_share", "upper bound", "", share, vehicle, "upper bound of the share",
     of_thruster<&ThrusterHealth::upper>, alert(never), series("bound", "upper")},
});

constexpr std::array kVelocity = std::to_array<HealthField<VelocityHealth>>({
    {"value", "velocity_estimate", "velocity", "", gauge, messages,
     "velocity, measured or reckoned, in the log's unit", of_velocity<&VelocityHealth::value>},
    {"deviation", "velocity_standard_deviation", "standard deviation", "", gauge, messages,
     "standard deviation of the velocity", of_velocity<&VelocityHealth::deviation>},
});

constexpr std::array kParameter = std::to_array<HealthField<ParameterHealth>>({
    {"value", "parameter_value", "value", "", gauge, vehicle,
     "estimate of a parameter, in the SI with a thrust known, else over the surge inertia",
     of_parameter<&ParameterHealth::value>},
    {"interval", "parameter_interval_ratio", "± of the value", "", share, vehicle,
     "half width of the parameter's 90 % interval over the parameter's size",
     of_parameter<&ParameterHealth::interval>},
});

}  // namespace tables

}  // namespace

template <>
std::span<const HealthField<Health>> health_fields() {
  return tables::kRun;
}
template <>
std::span<const HealthField<AxisHealth>> health_fields() {
  return tables::kAxis;
}
template <>
std::span<const HealthField<SourceHealth>> health_fields() {
  return tables::kSignal;
}
template <>
std::span<const HealthField<TopicHealth>> health_fields() {
  return tables::kTopic;
}
template <>
std::span<const HealthField<ThrusterHealth>> health_fields() {
  return tables::kThruster;
}
template <>
std::span<const HealthField<VelocityHealth>> health_fields() {
  return tables::kVelocity;
}
template <>
std::span<const HealthField<ParameterHealth>> health_fields() {
  return tables::kParameter;
}

namespace {

template <typename Of>
std::string name_of(const Of& of) {
  if constexpr (std::same_as<Of, Health>) {
    return {};
  } else {
    return of.name;
  }
}

// "u (/odom:x)".
template <typename Of>
std::string full_name_of(const Of& of) {
  if constexpr (std::same_as<Of, SourceHealth>) {
    return of.name + " (" + of.from + ")";
  } else {
    return name_of(of);
  }
}

bool is_raised(const AlertSettings& alert, double now, double before) {
  return alert.rule == AlertRule::present   ? now > alert.limit
         : alert.rule == AlertRule::growing ? now > before
                                            : now == 0.0;
}

std::string joined(const std::string& subject, std::string_view text) {
  return subject.empty() ? std::string(text) : subject + " " + std::string(text);
}

// "udot the vehicle has changed" would be no sentence: an axis is the status itself.
template <typename Of>
std::string alert_text(const HealthField<Of>& field, const Of& of, const std::string& subject) {
  const std::string own = field.get.text == nullptr ? "" : field.get.text(of);
  std::string text = std::same_as<Of, AxisHealth> ? std::string(field.alert.text)
                                                  : joined(subject, field.alert.text);
  if constexpr (std::same_as<Of, TopicHealth>) {
    text += field.get.text == nullptr ? ": " + of.last_error : "";
  }
  if (!own.empty()) {
    text += field.alert.text.empty() ? own : ": " + own;
  } else if (field.kind == HealthKind::gauge) {
    text += fmt::format(", for {:.0f} {}", field.get.number(of), field.unit);
  }
  return text;
}

// Calls `visit(field, now, before)` for each field of a health with an alert.
template <typename Visit>
void visit_alerts(const Health& now, const Health& before, Visit visit) {
  const auto fields = [&]<typename Of>(const Of& of, const Of& earlier) {
    for (const HealthField<Of>& field : health_fields<Of>()) {
      if (field.alert.rule != AlertRule::never) {
        visit(field, of, earlier);
      }
    }
  };
  const auto list = [&]<typename Of>(const std::vector<Of>& of, const std::vector<Of>& earlier) {
    for (std::size_t i = 0; i < of.size(); ++i) {
      // The totals of a new axis come from a checkpoint: no growth.
      const Of first = std::same_as<Of, AxisHealth> ? of[i] : Of{};
      fields(of[i], i < earlier.size() ? earlier[i] : first);
    }
  };
  list(now.topics, before.topics);
  list(now.sources, before.sources);
  list(now.learner.axes, before.learner.axes);
  fields(now, before);
}

template <typename Of>
void add_event(std::vector<std::string>& events, const HealthField<Of>& field, const Of& now,
               const Of& before) {
  const AlertSettings& alert = field.alert;
  // Growth is reported once, unless each one counts.
  const double least = alert.rule == AlertRule::present ? alert.limit : 0.0;
  const bool is_now = field.value(now) > least;
  const bool was_before = field.value(before) > least;
  const bool is_new = alert.event == AlertEvent::each ? field.value(now) > field.value(before)
                      : field.get.text != nullptr ? field.get.text(now) != field.get.text(before)
                                                  : !was_before;
  if (alert.event != AlertEvent::none && is_now && is_new) {
    events.push_back(alert_text(field, now, full_name_of(now)));
  } else if (alert.event == AlertEvent::ended && !is_now && was_before) {
    events.push_back(joined(full_name_of(now), alert.end));
  }
}

}  // namespace

std::vector<Alert> alerts_of(const Health& now, const Health& before) {
  std::vector<Alert> alerts;
  for (const std::string& fault : now.transport.faults) {
    alerts.push_back({HealthGroup::messages, AlertLevel::warn, {}, {}, fault});
  }
  visit_alerts(now, before,
               [&]<typename Of>(const HealthField<Of>& field, const Of& of, const Of& earlier) {
                 if (is_raised(field.alert, field.value(of), field.value(earlier))) {
                   alerts.push_back({field.group, field.alert.level, field.key, name_of(of),
                                     alert_text(field, of, name_of(of))});
                 }
               });
  std::ranges::stable_sort(alerts, std::ranges::greater{}, &Alert::level);
  return alerts;
}

std::vector<std::string> events_of(const Health& now, const Health& before) {
  std::vector<std::string> events;
  visit_alerts(now, before,
               [&]<typename Of>(const HealthField<Of>& field, const Of& of, const Of& earlier) {
                 add_event(events, field, of, earlier);
               });
  const auto has = [](const Health& health, const std::string& fault) {
    return std::ranges::count(health.transport.faults, fault) > 0;
  };
  for (const std::string& fault : now.transport.faults) {
    if (!has(before, fault)) {
      events.push_back(fault);
    }
  }
  for (const std::string& fault : before.transport.faults) {
    if (!has(now, fault)) {
      events.push_back("no more: " + fault);
    }
  }
  return events;
}

std::string health_text(HealthKind kind, double value) {
  if (kind == HealthKind::flag) {
    return value > 0.0 ? "yes" : "no";
  }
  if (!std::isfinite(value)) {
    return "unknown";
  }
  return kind == HealthKind::count ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value);
}

}  // namespace kelpie::live
