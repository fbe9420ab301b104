// SPDX-License-Identifier: Apache-2.0
#include "console/live_console.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "cli/output.hpp"
#include "live/health_table.hpp"
#include "report/sampling_table.hpp"

namespace kelpie::cli {

LiveConsole::LiveConsole(double status_s)
    : every_(status_s),
      terminal_(isatty(::fileno(streams().err)) == 1),
      shown_(std::chrono::steady_clock::now()),
      writer_([this] { write(); }) {}

LiveConsole::~LiveConsole() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  added_.notify_one();
  writer_.join();
  if (terminal_) {
    fmt::print(streams().err, "\r\033[K");
  }
}

void LiveConsole::add(Line line) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() >= kMostWaiting) {
      ++dropped_;
      return;
    }
    if (dropped_ > 0) {
      waiting_.push_back({.text = fmt::format("{} lines could not be written", dropped_)});
      dropped_ = 0;
    }
    waiting_.push_back(std::move(line));
  }
  added_.notify_one();
}

void LiveConsole::write() {
  std::unique_lock lock(mutex_);
  while (true) {
    added_.wait(lock, [&] { return ends_ || !waiting_.empty(); });
    if (waiting_.empty()) {
      return;
    }
    const Line line = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    write(line);
    lock.lock();
  }
}

void LiveConsole::write(const Line& line) const {
  if (terminal_) {
    fmt::print(streams().err, "\r\033[K{}", line.is_event ? "" : line.text);
    static_cast<void>(std::fflush(streams().err));
  }
  if (line.is_event) {
    warn("kelpie: {}\n", line.text);
  }
}

void LiveConsole::event(const std::string& line) {
  add({.text = line});
}

void LiveConsole::health(const live::Health& health) {
  if (terminal_) {
    add({.text = chart::shortened(status_text(health), 120), .is_event = false});
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  if (now - shown_ >= every_) {
    shown_ = now;
    add({.text = status_text(health)});
  }
}

std::string status_text(const live::Health& health) {
  std::string text = fmt::format("{:.1f} s, {} learned", health.learner.last_t_s,
                                 chart::grouped(health.learner.learned));
  for (const live::AxisHealth& axis : health.learner.axes) {
    text += fmt::format(", {} R² {}", axis.name, chart::decimal(axis.r2));
  }
  text += fmt::format(", delay {:.1f} ms", health.learner.median_delay_ms);
  for (const auto& field : live::health_fields<live::SourceHealth>()) {
    const auto raised =
        std::ranges::count_if(health.sources, [&](const live::SourceHealth& source) {
          return field.alert.event != live::AlertEvent::none && field.value(source) > 0.0;
        });
    if (raised > 0) {
      text += fmt::format(", {} of {} signals {}", raised, health.sources.size(), field.label);
    }
  }
  for (const auto& field : live::health_fields<live::Health>()) {
    const bool is_alert = field.alert.rule == live::AlertRule::present ||
                          field.alert.rule == live::AlertRule::growing;
    if (!is_alert || field.value(health) <= field.alert.limit) {
      continue;
    }
    const bool is_count = field.kind == live::HealthKind::count;
    text += is_count ? fmt::format(", {} {}", field.label,
                                   chart::grouped(static_cast<std::int64_t>(field.value(health))))
                     : fmt::format(", {}", field.label);
  }
  return text;
}

namespace {

std::string found_text(const live::SourceHealth& source) {
  std::string text = report::faults_text(source.faults);
  if (source.is_silent() && std::isfinite(source.silent_s)) {
    text +=
        fmt::format("{}ends {:.0f} s before the log", text.empty() ? "" : ", ", source.silent_s);
  }
  return text;
}

}  // namespace

std::string final_table(const live::Health& health) {
  chart::TextTable signals{.title = {},
                           .head = {"signal", "samples", "found"},
                           .rows = {},
                           .left = {0, 2},
                           .whole = true};
  for (const live::SourceHealth& source : health.sources) {
    signals.rows.push_back(
        {source.name, std::to_string(source.faults.samples), found_text(source)});
  }
  for (const live::TopicHealth& topic : health.topics) {
    if (topic.undecodable > 0) {
      signals.notes.push_back(
          fmt::format("{} messages of {} that aren't of its type", topic.undecodable, topic.name));
    }
  }
  for (const auto& field : live::health_fields<live::Health>()) {
    if (field.kind == live::HealthKind::count && field.value(health) > 0.0) {
      signals.notes.push_back(fmt::format("{:.0f} {}", field.value(health), field.help));
    } else if (field.kind == live::HealthKind::text && field.value(health) > 0.0) {
      signals.notes.push_back(field.get.text(health));
    }
  }
  chart::TextTable axes{.title = {}, .head = {"axis"}, .rows = {}};
  for (const live::AxisHealth& axis : health.learner.axes) {
    axes.head.push_back(axis.name);
  }
  for (const auto& field : live::health_fields<live::AxisHealth>()) {
    if (!field.label.empty()) {
      std::vector<std::string>& row = axes.rows.emplace_back(1, std::string(field.label));
      for (const live::AxisHealth& axis : health.learner.axes) {
        row.push_back(live::value_text(field, axis));
      }
    }
  }
  return chart::table_text(signals) + chart::table_text(axes);
}

}  // namespace kelpie::cli
