// SPDX-License-Identifier: Apache-2.0
#include "ros/diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kelpie/core/text.hpp"
#include "live/alignment.hpp"

namespace kelpie::ros {
namespace {

using Level = DiagnosticStatus::Level;

constexpr double kSilence = 2.0;  // s

// The first thing that is wrong is what the message says; the worst one is the level.
void note(DiagnosticStatus& diagnosis, bool is_so, Level level, const std::string& text) {
  if (is_so) {
    diagnosis.message = diagnosis.level == Level::ok ? text : diagnosis.message + "; " + text;
    diagnosis.level = std::max(diagnosis.level, level);
  }
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : std::string("unknown");
}

std::size_t undecodable(const live::Health& health) {
  std::size_t count = 0;
  for (const live::TopicHealth& topic : health.topics) {
    count += topic.undecodable;
  }
  return count;
}

DiagnosticStatus status_of_messages(const live::Health& now, const live::Health& before,
                                    const live::Configuration& configuration) {
  DiagnosticStatus found{.name = "messages", .message = "messages come"};
  note(found, now.idle_s > kSilence, Level::error,
       fmt::format("no messages come, for {:.0f} s", now.idle_s));
  for (const live::TopicHealth& topic : now.topics) {
    note(found, !topic.refused.empty(), Level::error,
         topic.name + " is of no use: " + topic.refused);
    found.values.emplace_back(topic.name, fmt::format("{} messages, {} not of its type",
                                                      topic.messages, topic.undecodable));
  }
  for (const std::string& fault : now.transport.faults) {
    note(found, true, Level::warn, fault);
  }
  for (const live::SourceHealth& source : now.sources) {
    const bool is_silent = source.silent_s > configuration.plan.gap_s;
    note(found, is_silent, Level::warn, source.name + " is silent");
    note(found, source.is_stuck, Level::warn, source.name + " doesn't change any more");
    found.values.emplace_back(
        source.name, fmt::format("{}{:.1f} Hz, {} late, {} without a value",
                                 is_silent ? "silent, " : "", source.rate_hz, source.faults.late,
                                 source.faults.no_value + source.faults.no_stamp));
  }
  note(found, undecodable(now) > undecodable(before), Level::warn,
       "messages come that aren't of their type");
  note(found, now.transport.lost > before.transport.lost, Level::warn, "messages are lost");
  found.values.emplace_back("messages lost", std::to_string(now.transport.lost));
  found.values.emplace_back("clock set back", std::to_string(now.clock_restarts));
  return found;
}

DiagnosticStatus status_of_learning(const live::Health& now, const live::Health& before) {
  const live::LearnerHealth& learner = now.learner;
  const bool is_ready = std::ranges::any_of(
      learner.axes, [](const live::AxisHealth& axis) { return axis.status.ready; });
  DiagnosticStatus found{.name = "learning", .message = "learning"};
  note(found, learner.is_paused, Level::warn, "learning is frozen, as was asked");
  note(found, !is_ready, Level::warn, "no model yet");
  note(found, learner.frozen > before.learner.frozen, Level::warn,
       "rows with a frozen velocity aren't learned");
  note(found, now.rows_dropped > before.rows_dropped, Level::error,
       "the learner is behind: rows are lost");
  found.values = {{"rows", std::to_string(now.rows)},
                  {"rows incomplete", std::to_string(now.rows_incomplete)},
                  {"rows lost", std::to_string(now.rows_dropped)},
                  {"rows waiting", std::to_string(now.rows_waiting)},
                  {"samples learned", std::to_string(learner.learned)},
                  {"commands", live::shift_text(learner.alignment)},
                  {"delay/ms, median", number(learner.median_delay_ms)},
                  {"delay/ms, longest", number(learner.longest_delay_ms)}};
  return found;
}

DiagnosticStatus status_of_axis(const live::AxisHealth& now, const live::AxisHealth* before) {
  const Tally& tally = now.status.tally;
  DiagnosticStatus found{.name = now.name,
                         .message = now.status.ready ? "a model is in service" : "no model yet"};
  note(found, before != nullptr && tally.changes > before->status.tally.changes, Level::warn,
       "the vehicle has changed");
  found.values = {{"R² of late", number(now.r2)},
                  {"inside interval", number(now.coverage)},
                  {"disturbance", number(now.disturbance)},
                  {"buffer", std::to_string(now.status.buffer)},
                  {"support vectors", std::to_string(now.status.support_vectors)},
                  {"changes", std::to_string(tally.changes)},
                  {"withdrawn", std::to_string(tally.withdrawn)},
                  {"outliers", std::to_string(tally.outliers)},
                  {"implausible", std::to_string(tally.implausible)}};
  return found;
}

DiagnosticStatus status_of_vehicle(const live::LearnerHealth& learner,
                                   const live::Configuration& configuration) {
  DiagnosticStatus found{.name = "vehicle", .message = "no change was found"};
  note(found, !learner.vehicle.empty(), Level::warn, learner.vehicle);
  found.values.emplace_back("thrusters watched", std::to_string(learner.thrusters.size()));
  for (const Cause& cause : learner.thrusters) {
    found.values.emplace_back(
        configuration.plan.inputs[cause.place] + ", share of its thrust",
        fmt::format("{:.2f} ({:.2f} to {:.2f})", cause.size, cause.lower, cause.upper));
  }
  return found;
}

DiagnosticStatus status_of_disk(const live::Health& now) {
  const live::LearnerHealth& learner = now.learner;
  DiagnosticStatus found{
      .name = "disk",
      .message = learner.checkpoints > 0 ? "checkpoints are written" : "no checkpoint was due yet"};
  note(found, !learner.checkpoint_error.empty(), Level::error,
       "no checkpoint can be written: " + learner.checkpoint_error);
  note(found, !now.record_error.empty(), Level::warn, now.record_error);
  found.values = {{"checkpoints", std::to_string(learner.checkpoints)},
                  {"checkpoints failed", std::to_string(learner.checkpoints_failed)}};
  if (learner.checkpoints > 0) {
    found.values.emplace_back("age of the checkpoint/s",
                              number(learner.last_t_s - learner.checkpoint_t_s));
  }
  return found;
}

}  // namespace

std::vector<DiagnosticStatus> diagnose(const live::Health& now, const live::Health& before,
                                       const live::Configuration& configuration) {
  std::vector<DiagnosticStatus> all{status_of_messages(now, before, configuration),
                                    status_of_learning(now, before),
                                    status_of_vehicle(now.learner, configuration)};
  const std::vector<live::AxisHealth>& earlier = before.learner.axes;
  for (std::size_t i = 0; i < now.learner.axes.size(); ++i) {
    all.push_back(status_of_axis(now.learner.axes[i], i < earlier.size() ? &earlier[i] : nullptr));
  }
  all.push_back(status_of_disk(now));
  return all;
}

}  // namespace kelpie::ros
