// SPDX-License-Identifier: Apache-2.0
#include "report/recommendation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "chart/wording.hpp"
#include "core/text.hpp"
#include "report/tuning.hpp"

namespace kelpie::report {
namespace {

using study::ContenderKind;
using study::Contest;
using study::use_of;

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

// Null where it didn't take part.
const Contest* contest_of(const study::Comparison& comparison, ContenderKind kind) {
  const auto found = std::ranges::find(comparison.contests, kind, &Contest::kind);
  return found == comparison.contests.end() ? nullptr : &*found;
}

double final_r2(const Contest* contest, std::size_t axis) {
  return contest == nullptr ? kNotMeasured : contest->stream.axes[axis].r2_final;
}

// The greatest R² of a variant on an axis; NaN without any.
double best_variant(const study::Comparison& comparison, std::size_t axis) {
  double best = kNotMeasured;
  for (const Contest& contest : comparison.contests) {
    if (contest.kind == ContenderKind::variant) {
      best = std::fmax(best, final_r2(&contest, axis));
    }
  }
  return best;
}

std::string against(double value, double other) {
  return fmt::format("(R² {} against {})", chart::decimal(value), chart::decimal(other));
}

// An axis on which nobody has found anything.
std::string of_no_use(double kelpie, double mean) {
  const std::string worse = kelpie < mean - kTuning.clear_r2
                                ? " kelpie is worse: don't use what it says of this axis."
                                : "";
  return fmt::format(
      "nothing here predicts better than the mean {}: nothing in the inputs explains it.{} Look "
      "for an input that is missing (wind, waves, a tether), a column or unit that is wrong, and "
      "commands that are shifted in time; until then use the mean.",
      against(kelpie, mean), worse);
}

Advice of_axis(const study::Comparison& comparison, std::size_t axis) {
  const double kelpie = final_r2(&comparison.contests.front(), axis);
  if (!std::isfinite(kelpie)) {
    return {"kelpie has no R² here, so there is nothing to compare."};
  }
  const double mean = final_r2(contest_of(comparison, ContenderKind::mean), axis);
  const double fit = final_r2(contest_of(comparison, ContenderKind::least_squares), axis);
  if (std::fmax(kelpie, std::fmax(fit, best_variant(comparison, axis))) <=
      use_of(mean) + kTuning.clear_r2) {
    return {of_no_use(kelpie, mean)};
  }
  std::vector<std::string> parts;
  if (kelpie <= mean + kTuning.clear_r2) {
    parts.push_back(fmt::format("kelpie is no better than the mean {}.", against(kelpie, mean)));
  }
  if (fit > kelpie + kTuning.clear_r2) {
    parts.push_back(fmt::format(
        "least squares on physics terms is better {}: kelpie has not learned more than these "
        "terms here. Search settings with `kelpie tune`, or drive longer.",
        against(fit, kelpie)));
  }
  if (parts.empty()) {
    return {fmt::format("kelpie is the best here, or within {} of it (R² {}).", kTuning.clear_r2,
                        chart::decimal(kelpie)),
            false};
  }
  return {join_text(parts, " ")};
}

// Nothing where kelpie is as good everywhere.
std::string of_one_step(const study::Comparison& comparison) {
  const Contest& kelpie = comparison.contests.front();
  const Contest* const last = contest_of(comparison, ContenderKind::last_value);
  std::vector<std::string> axes;
  for (std::size_t i = 0; last != nullptr && i < kelpie.stream.axes.size(); ++i) {
    const study::AxisResult& axis = kelpie.stream.axes[i];
    const double repeated = last->stream.axes[i].prequential_r2;
    if (repeated > axis.prequential_r2 + kTuning.clear_one_step_r2) {
      axes.push_back(axis.name + " " + against(repeated, axis.prequential_r2));
    }
  }
  return axes.empty()
             ? ""
             : "One step ahead, repeating the last value is better on " + join_text(axes, ", ") +
                   ": use kelpie's predictions for what lies further ahead.";
}

}  // namespace

std::vector<Advice> all_advice(const study::Comparison& comparison) {
  std::vector<Advice> all;
  const std::vector<study::AxisResult>& axes = comparison.contests.front().stream.axes;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    Advice& advice = all.emplace_back(of_axis(comparison, axis));
    advice.text = axes[axis].name + ": " + advice.text;
  }
  for (const Advice& advice :
       {Advice{of_one_step(comparison)}, Advice{settings_advice(comparison), false}}) {
    if (!advice.text.empty()) {
      all.push_back(advice);
    }
  }
  return all;
}

std::vector<std::string> recommendation(const study::Comparison& comparison) {
  std::vector<std::string> paragraphs;
  std::ranges::transform(all_advice(comparison), std::back_inserter(paragraphs), &Advice::text);
  return paragraphs;
}

std::vector<std::string> variants_of(const study::Comparison& comparison) {
  std::vector<std::string> names;
  for (const Contest& contest : comparison.contests) {
    if (contest.kind == ContenderKind::variant) {
      names.push_back(contest.name);
    }
  }
  return names;
}

std::string settings_advice(const study::Comparison& comparison) {
  const std::vector<std::string> tried = variants_of(comparison);
  if (tried.empty()) {
    return "";
  }
  if (const Contest* const better = comparison.better_variant()) {
    std::vector<std::string> inner;
    for (const double gain : better->inner_gains) {
      inner.push_back(chart::decimal(gain));
    }
    const double held_out = study::mean_gain(better->stream, comparison.contests.front().stream);
    return fmt::format(
        "Use --set {}: R² is higher by {} on inner splits of the training rows, and by {} on the "
        "held-out rows (means over the axes).",
        better->name, join_text(inner, " and "), chart::decimal(held_out));
  }
  return fmt::format(
      "No gain: keep the defaults. None of the settings tried ({}) is better by more than {} both "
      "on inner splits of the training rows and on the held-out rows (means over the axes).",
      join_text(tried, ", "), kTuning.clear_r2);
}

}  // namespace kelpie::report
