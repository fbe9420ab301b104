// SPDX-License-Identifier: Apache-2.0
#include "cli/live_console.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "cli/output.hpp"
#include "report/sampling_table.hpp"

namespace kelpie::cli {

LiveConsole::LiveConsole(double status_s)
    : every_(status_s),
      terminal_(isatty(STDERR_FILENO) == 1),
      shown_(std::chrono::steady_clock::now()) {}

LiveConsole::~LiveConsole() {
  if (terminal_) {
    fmt::print(stderr, "\r\033[K");
  }
}

void LiveConsole::event(const std::string& line) {
  if (terminal_) {
    fmt::print(stderr, "\r\033[K");
  }
  warn("kelpie: {}\n", line);
}

void LiveConsole::health(const live::Health& health) {
  if (terminal_) {
    fmt::print(stderr, "\r\033[K{}", chart::shortened(status_text(health), 120));
    static_cast<void>(std::fflush(stderr));
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  if (now - shown_ >= every_) {
    shown_ = now;
    warn("kelpie: {}\n", status_text(health));
  }
}

std::string status_text(const live::Health& health) {
  std::string text = fmt::format("{:.1f} s, {} learned", health.learner.last_t_s,
                                 chart::grouped(static_cast<std::int64_t>(health.learner.learned)));
  for (const live::AxisHealth& axis : health.learner.axes) {
    text += fmt::format(", {} R² {}", axis.name, chart::decimal(axis.r2));
  }
  text += fmt::format(", delay {:.1f} ms", health.learner.median_delay_ms);
  const auto silent = std::ranges::count_if(
      health.sources, [](const live::SourceHealth& source) { return source.silent_s > 1.0; });
  if (silent > 0) {
    text += fmt::format(", {} of {} signals silent", silent, health.sources.size());
  }
  if (health.transport.lost > 0) {
    text += fmt::format(", {} messages lost", health.transport.lost);
  }
  if (health.rows_dropped > 0) {
    text += fmt::format(", {} rows lost", health.rows_dropped);
  }
  if (!health.learner.checkpoint_error.empty()) {
    text += ", no checkpoint";
  }
  return text;
}

std::string health_table(const live::Health& health) {
  chart::TextTable signals{.title = {},
                           .head = {"signal", "samples", "found"},
                           .rows = {},
                           .left = {0, 2},
                           .whole = true};
  for (const live::SourceHealth& source : health.sources) {
    signals.rows.push_back(
        {source.name, std::to_string(source.faults.samples), report::faults_text(source.faults)});
  }
  const live::LearnerHealth& learner = health.learner;
  const auto note = [&](std::size_t count, const char* what) {
    if (count > 0) {
      signals.notes.push_back(fmt::format("{} {}", count, what));
    }
  };
  for (const live::TopicHealth& topic : health.topics) {
    note(topic.undecodable, ("messages of " + topic.name + " that aren't of its type").c_str());
  }
  note(health.transport.lost, "messages lost on their way");
  note(health.transport.damaged, "frames that were no whole ones");
  note(health.transport.unknown, "messages without a definition");
  note(health.clock_restarts, "times a clock was set back");
  note(health.rows_incomplete, "rows with a value missing, not learned");
  note(learner.paused, "rows while learning was frozen, not learned");
  note(learner.frozen, "rows with a frozen velocity, not learned");
  note(health.rows_dropped, "rows lost, the learner was behind");
  note(learner.checkpoints_failed, "checkpoints that couldn't be written");
  signals.notes.push_back(fmt::format("{} samples learned", learner.learned));
  chart::TextTable axes{
      .title = {}, .head = {"axis", "samples kept", "R² of late", "inside interval/%"}, .rows = {}};
  for (const live::AxisHealth& axis : learner.axes) {
    axes.rows.push_back(
        {axis.name, std::to_string(axis.status.buffer), chart::decimal(axis.r2),
         std::isnan(axis.coverage) ? "–" : fmt::format("{:.0f}", 100.0 * axis.coverage)});
  }
  if (!learner.vehicle.empty()) {
    signals.notes.push_back(learner.vehicle);
  }
  return chart::table_text(signals) + chart::table_text(axes);
}

}  // namespace kelpie::cli
