// SPDX-License-Identifier: Apache-2.0
#include "web/metrics.hpp"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chart/wording.hpp"
#include "live/health_table.hpp"

namespace kelpie::web {
namespace {

using Labels = std::vector<std::pair<std::string_view, std::string_view>>;

std::string escaped(std::string_view value) {
  std::string text;
  for (const char c : chart::safe_text(value)) {
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
  void name(std::string_view name, std::string_view meaning) {
    const std::string whole = fmt::format("kelpie_{}", name);
    if (whole != name_) {
      name_ = whole;
      text_ += fmt::format("# HELP {0} {1}.\n# TYPE {0} {2}\n", name_, meaning,
                           name.ends_with("_total") ? "counter" : "gauge");
    }
  }
  void value(double value, const Labels& labels = {}) {
    std::string list;
    for (const auto& [label, content] : labels) {
      list += fmt::format("{}{}=\"{}\"", list.empty() ? "" : ",", label, escaped(content));
    }
    text_ += name_ + (list.empty() ? "" : "{" + list + "}") + " " + number(value) + "\n";
  }
  std::string text() { return std::move(text_); }

 private:
  std::string name_;
  std::string text_;
};

// Each field with a metric, for each entry of `list`; `label` says what an entry is.
template <typename Of>
void add_fields(Metrics& metrics, std::span<const Of> list, std::string_view label) {
  const auto add = [&](const live::HealthField<Of>& field, std::string_view name) {
    if (name.empty()) {
      return;
    }
    metrics.name(name, field.help);
    for (const Of& of : list) {
      Labels labels;
      if constexpr (requires { of.name; }) {
        labels.emplace_back(label, of.name);
      }
      if (!field.names.series.first.empty()) {
        labels.push_back(field.names.series);
      }
      metrics.value(field.metric_value(of), labels);
    }
  };
  for (const live::HealthField<Of>& field : live::health_fields<Of>()) {
    add(field, field.metric);
    add(field, field.names.old_metric);
  }
}

void add_coefficients(Metrics& metrics, const std::vector<live::AxisHealth>& axes) {
  const auto add = [&](std::string_view name, std::string_view meaning,
                       double Coefficient::*value) {
    metrics.name(name, meaning);
    for (const live::AxisHealth& axis : axes) {
      for (const Coefficient& coefficient : axis.coefficients) {
        metrics.value(coefficient.*value, {{"axis", axis.name}, {"term", coefficient.term}});
      }
    }
  };
  add("axis_coefficient", "of a physics term, in target units per unit of the term",
      &Coefficient::value);
  add("axis_coefficient_standard_error", "of the coefficient, NaN where it isn't known",
      &Coefficient::error);
}

}  // namespace

std::string metrics_text(const live::Health& health) {
  Metrics metrics;
  add_fields(metrics, std::span(&health, 1), "");
  live::visit_health_lists(health, [&](const auto& list, std::string_view label) {
    add_fields(metrics, std::span(list), label);
  });
  add_coefficients(metrics, health.learner.axes);
  metrics.name("signal_info", "topic and field of a signal; always 1");
  for (const live::SourceHealth& signal : health.sources) {
    metrics.value(1.0, {{"signal", signal.name}, {"from", signal.from}});
  }
  return metrics.text();
}

}  // namespace kelpie::web
