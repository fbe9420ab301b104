// SPDX-License-Identifier: Apache-2.0
#include "report/recommendation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "chart/wording.hpp"
#include "core/text.hpp"
#include "report/tuning.hpp"

namespace kelpie::report {
namespace {

using study::ContenderKind;
using study::Contest;

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

// Null where it didn't take part.
const Contest* contest_of(const study::Comparison& comparison, ContenderKind kind) {
  const auto found = std::ranges::find(comparison.contests, kind, &Contest::kind);
  return found == comparison.contests.end() ? nullptr : &*found;
}

double final_r2(const Contest* contest, std::size_t axis) {
  return contest == nullptr ? kNotMeasured : contest->stream.axes[axis].r2_final;
}

// What is worse than the held-out rows' own mean is of no use, however much.
double use_of(double r2) {
  return r2 < 0.0 ? 0.0 : r2;
}

// Mean over the axes on which both have an R², of how much more use `contest` is.
double mean_gain(const Contest& contest, const Contest& kelpie) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t axis = 0; axis < kelpie.stream.axes.size(); ++axis) {
    const double gain = use_of(final_r2(&contest, axis)) - use_of(final_r2(&kelpie, axis));
    if (std::isfinite(gain)) {
      sum += gain;
      ++count;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : kNotMeasured;
}

// The variant with the greatest finite score; null without any.
template <typename Score>
const Contest* best_variant(const study::Comparison& comparison, Score score) {
  const Contest* best = nullptr;
  for (const Contest& contest : comparison.contests) {
    if (contest.kind == ContenderKind::variant && std::isfinite(score(contest)) &&
        (best == nullptr || score(contest) > score(*best))) {
      best = &contest;
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

std::string of_axis(const study::Comparison& comparison, std::size_t axis) {
  const double kelpie = final_r2(&comparison.contests.front(), axis);
  if (!std::isfinite(kelpie)) {
    return "kelpie has no R² here, so there is nothing to compare.";
  }
  const double mean = final_r2(contest_of(comparison, ContenderKind::mean), axis);
  const double fit = final_r2(contest_of(comparison, ContenderKind::least_squares), axis);
  const Contest* const variant =
      best_variant(comparison, [&](const Contest& one) { return final_r2(&one, axis); });
  const double varied = final_r2(variant, axis);
  if (std::fmax(kelpie, std::fmax(fit, varied)) <= use_of(mean) + kTuning.clear_r2) {
    return of_no_use(kelpie, mean);
  }
  std::vector<std::string> parts;
  if (kelpie <= mean + kTuning.clear_r2) {
    parts.push_back(fmt::format("kelpie is no better than the mean {}.", against(kelpie, mean)));
  }
  if (fit > kelpie + kTuning.clear_r2) {
    parts.push_back(
        fmt::format("least squares on physics terms is better {}. Use it for this axis "
                    "(docs/compare.md says how "
                    "to make it), or search settings with `kelpie tune`.",
                    against(fit, kelpie)));
  }
  if (varied > kelpie + kTuning.clear_r2) {
    parts.push_back(fmt::format("--set {} is better {}.", variant->name, against(varied, kelpie)));
  }
  return parts.empty() ? fmt::format("kelpie is the best here, or within {} of it (R² {}).",
                                     kTuning.clear_r2, chart::decimal(kelpie))
                       : join_text(parts, " ");
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

// Nothing where none was tried.
std::string of_settings(const study::Comparison& comparison) {
  const Contest& kelpie = comparison.contests.front();
  std::vector<std::string> tried;
  bool helps_somewhere = false;
  for (const Contest& contest : comparison.contests) {
    if (contest.kind == ContenderKind::variant) {
      tried.push_back(contest.name);
      for (std::size_t i = 0; i < kelpie.stream.axes.size(); ++i) {
        helps_somewhere = helps_somewhere || use_of(final_r2(&contest, i)) >
                                                 use_of(final_r2(&kelpie, i)) + kTuning.clear_r2;
      }
    }
  }
  if (tried.empty()) {
    return "";
  }
  const auto gain = [&](const Contest& one) { return mean_gain(one, kelpie); };
  const Contest* const best = best_variant(comparison, gain);
  const bool better = best != nullptr && gain(*best) > kTuning.clear_r2;
  std::string text =
      better ? fmt::format("For all axes together --set {} is better, by {} in the mean.",
                           best->name, chart::decimal(gain(*best)))
             : fmt::format(
                   "For all axes together none of the settings tried ({}) is better by "
                   "more than {} in the mean: leave them as they are.",
                   join_text(tried, ", "), kTuning.clear_r2);
  if (better || helps_somewhere) {
    text +=
        " Which setting is better was chosen on the held-out rows themselves, so its R² is too "
        "good; try it on another log or split before you rely on it.";
  }
  return text;
}

}  // namespace

std::vector<std::string> recommendation(const study::Comparison& comparison) {
  std::vector<std::string> paragraphs;
  const std::vector<study::AxisResult>& axes = comparison.contests.front().stream.axes;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    paragraphs.push_back(axes[axis].name + ": " + of_axis(comparison, axis));
  }
  for (const std::string& text : {of_one_step(comparison), of_settings(comparison)}) {
    if (!text.empty()) {
      paragraphs.push_back(text);
    }
  }
  return paragraphs;
}

}  // namespace kelpie::report
