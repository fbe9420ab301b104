// SPDX-License-Identifier: Apache-2.0
#include "web/metrics.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <utility>
#include <vector>

#include "chart/wording.hpp"

namespace kelpie::web {
namespace {

using Labels = std::initializer_list<std::pair<std::string_view, std::string_view>>;

std::string escaped(std::string_view value) {
  std::string text;
  for (const char c : chart::printable(value)) {
    if (c == '\\' || c == '"') {
      text += '\\';
    }
    text += c;  // printable: there is no newline
  }
  return text;
}

std::string number(double value) {
  return std::isnan(value)   ? "NaN"
         : std::isinf(value) ? (value > 0 ? "+Inf" : "-Inf")
                             : fmt::format("{}", value);
}

class Metrics {
 public:
  // Values of one name follow, one with every value() call.
  void name(std::string_view name, std::string_view kind, std::string_view meaning) {
    name_ = fmt::format("kelpie_{}", name);
    text_ += fmt::format("# HELP {0} {1}\n# TYPE {0} {2}\n", name_, meaning, kind);
  }
  void value(double value, Labels labels = {}) {
    std::string list;
    for (const auto& [label, content] : labels) {
      list += fmt::format("{}{}=\"{}\"", list.empty() ? "" : ",", label, escaped(content));
    }
    text_ += name_ + (list.empty() ? "" : "{" + list + "}") + " " + number(value) + "\n";
  }
  template <typename Value>
  void count(std::string_view what, std::string_view meaning, Value count) {
    name(what, "counter", meaning);
    value(static_cast<double>(count));
  }
  void gauge(std::string_view what, std::string_view meaning, double now) {
    name(what, "gauge", meaning);
    value(now);
  }
  std::string text() { return std::move(text_); }

 private:
  std::string name_;
  std::string text_;
};

void add_learner(Metrics& metrics, const live::Health& health) {
  const live::LearnerHealth& learner = health.learner;
  metrics.count("rows_total", "Rows made of messages.", health.rows);
  metrics.count("rows_incomplete_total", "Rows with a value missing.", health.rows_incomplete);
  metrics.count("rows_dropped_total", "Rows lost, since the learner was behind.",
                health.rows_dropped);
  metrics.count("rows_stuck_total", "Rows passed over, since a velocity didn't change any more.",
                learner.frozen);
  metrics.count("rows_paused_total", "Rows passed over while learning was frozen.", learner.paused);
  metrics.gauge("rows_waiting", "Rows that wait for the learner.",
                static_cast<double>(health.rows_waiting));
  metrics.gauge("samples_learned", "Samples shown to the model, before this start as well.",
                static_cast<double>(learner.learned));
  metrics.gauge("learning_frozen", "1 where nothing is learned, as somebody asked.",
                learner.is_paused ? 1.0 : 0.0);
  metrics.gauge("row_time_seconds", "The last row, by the vehicle's clock since the origin.",
                learner.last_t_s);
  metrics.gauge("idle_seconds", "For how long no message has come.", health.idle_s);
  metrics.gauge("row_delay_median_seconds", "From a row's last message to its being learned.",
                learner.median_delay_ms / 1e3);
  metrics.gauge("row_delay_longest_seconds", "The same, the longest of the last rows.",
                learner.longest_delay_ms / 1e3);
  metrics.gauge("command_shift_seconds", "How much later commands are taken.",
                learner.alignment.lag_s);
  metrics.count("clock_restarts_total", "Times a clock was set back.", health.clock_restarts);
  metrics.count("checkpoints_total", "Checkpoints written.", learner.checkpoints);
  metrics.count("checkpoints_failed_total", "Checkpoints that couldn't be written.",
                learner.checkpoints_failed);
  metrics.gauge("checkpoint_time_seconds",
                "The last row in the newest checkpoint, as kelpie_row_time_seconds.",
                learner.checkpoint_t_s);
  metrics.gauge("recording_failed", "1 where recording has ended for an error.",
                health.record_error.empty() ? 0.0 : 1.0);
}

void add_axes(Metrics& metrics, const std::vector<live::AxisHealth>& axes) {
  const auto gauge = [&](std::string_view name, std::string_view meaning, auto value) {
    metrics.name(name, "gauge", meaning);
    for (const live::AxisHealth& axis : axes) {
      metrics.value(static_cast<double>(value(axis)), {{"axis", axis.name}});
    }
  };
  metrics.name("axis_r2", "gauge", "R2 one step ahead, over the last samples.");
  for (const live::AxisHealth& axis : axes) {
    metrics.value(axis.r2, {{"axis", axis.name}, {"predictor", "model"}});
    metrics.value(axis.r2_least_squares, {{"axis", axis.name}, {"predictor", "least_squares"}});
    metrics.value(axis.r2_mean, {{"axis", axis.name}, {"predictor", "mean"}});
    metrics.value(axis.r2_last_value, {{"axis", axis.name}, {"predictor", "last_value"}});
  }
  gauge("axis_coverage_ratio", "Share of the last samples inside their interval.",
        [](const live::AxisHealth& axis) { return axis.coverage; });
  gauge("axis_disturbance", "What the present disturbance adds, in the target's unit.",
        [](const live::AxisHealth& axis) { return axis.disturbance; });
  gauge("axis_ready", "1 where a model is in service.",
        [](const live::AxisHealth& axis) { return axis.status.ready ? 1 : 0; });
  gauge("axis_buffer_samples", "Samples that the model keeps.",
        [](const live::AxisHealth& axis) { return axis.status.buffer; });
  metrics.name("axis_changes_total", "counter", "Changes of the vehicle that were found.");
  for (const live::AxisHealth& axis : axes) {
    metrics.value(static_cast<double>(axis.status.tally.changes), {{"axis", axis.name}});
  }
  const auto coefficients = [&](std::string_view name, std::string_view meaning,
                                double Coefficient::*value) {
    metrics.name(name, "gauge", meaning);
    for (const live::AxisHealth& axis : axes) {
      for (const Coefficient& coefficient : axis.coefficients) {
        metrics.value(coefficient.*value, {{"axis", axis.name}, {"term", coefficient.term}});
      }
    }
  };
  coefficients("axis_coefficient", "Of a physics term, in target units per unit of the term.",
               &Coefficient::value);
  coefficients("axis_coefficient_standard_error", "Of the same, NaN where it isn't known.",
               &Coefficient::error);
}

void add_signals(Metrics& metrics, const std::vector<live::SourceHealth>& signals) {
  const auto all = [&](std::string_view name, std::string_view kind, std::string_view meaning,
                       auto value) {
    metrics.name(name, kind, meaning);
    for (const live::SourceHealth& signal : signals) {
      metrics.value(static_cast<double>(value(signal)), {{"signal", signal.name}});
    }
  };
  metrics.name("signal_info", "gauge", "Topic and field of a signal; always 1.");
  for (const live::SourceHealth& signal : signals) {
    metrics.value(1.0, {{"signal", signal.name}, {"from", signal.from}});
  }
  all("signal_rate_hertz", "gauge", "Samples per second of the vehicle's clock.",
      [](const live::SourceHealth& signal) { return signal.rate_hz; });
  all("signal_silent_seconds", "gauge", "For how long it has been silent.",
      [](const live::SourceHealth& signal) { return signal.silent_s; });
  all("signal_stuck", "gauge", "1 where its value doesn't change any more.",
      [](const live::SourceHealth& signal) { return signal.is_stuck ? 1 : 0; });
  all("signal_samples_total", "counter", "Samples that are used.",
      [](const live::SourceHealth& signal) { return signal.faults.samples; });
  using Kind = std::pair<std::string_view, std::size_t SignalFaults::*>;
  static constexpr std::array<Kind, 6> kKinds{{{"no_value", &SignalFaults::no_value},
                                               {"no_stamp", &SignalFaults::no_stamp},
                                               {"duplicate", &SignalFaults::duplicates},
                                               {"late", &SignalFaults::late},
                                               {"silence", &SignalFaults::gaps},
                                               {"stuck", &SignalFaults::stuck}}};
  metrics.name("signal_faults_total", "counter", "What was found wrong with it, by kind.");
  for (const live::SourceHealth& signal : signals) {
    for (const auto& [kind, faults] : kKinds) {
      metrics.value(static_cast<double>(signal.faults.*faults),
                    {{"signal", signal.name}, {"kind", kind}});
    }
  }
}

void add_topics(Metrics& metrics, const std::vector<live::TopicHealth>& topics) {
  const auto all = [&](std::string_view name, std::string_view kind, std::string_view meaning,
                       auto value) {
    metrics.name(name, kind, meaning);
    for (const live::TopicHealth& topic : topics) {
      metrics.value(static_cast<double>(value(topic)), {{"topic", topic.name}});
    }
  };
  all("topic_messages_total", "counter", "Messages that came.",
      [](const live::TopicHealth& topic) { return topic.messages; });
  all("topic_undecodable_total", "counter", "Messages that aren't of their topic's type.",
      [](const live::TopicHealth& topic) { return topic.undecodable; });
  all("topic_refused", "gauge", "1 where its type is of no use.",
      [](const live::TopicHealth& topic) { return topic.refused.empty() ? 0 : 1; });
}

}  // namespace

std::string metrics_text(const live::Health& health) {
  Metrics metrics;
  add_learner(metrics, health);
  add_axes(metrics, health.learner.axes);
  add_signals(metrics, health.sources);
  add_topics(metrics, health.topics);
  return metrics.text();
}

}  // namespace kelpie::web
