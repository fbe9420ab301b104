// SPDX-License-Identifier: Apache-2.0
#include "report/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "chart/wording.hpp"
#include "core/text.hpp"
#include "kelpie/motion/attitude.hpp"
#include "motion/states.hpp"
#include "report/stream_figures.hpp"
#include "report/tuning.hpp"
#include "study/diagnosis.hpp"

namespace kelpie::report {
namespace {

constexpr double kMinute = 60.0;

std::string line(const std::string& text) {
  return chart::wrapped(chart::safe_text(text)) + "\n";
}

// 0 for R² below 0 or not measured: the mean of the held-out rows has 0.
double at_least_mean(double r2) {
  return std::isfinite(r2) ? std::max(r2, 0.0) : 0.0;
}

std::string quality(double r2, bool caveat) {
  if (r2 >= kTuning.good_r2 && !caveat) {
    return r2 >= kTuning.very_good_r2 ? "very good" : "good";
  }
  return r2 >= kTuning.fair_r2 ? "fair" : "weak";
}

using Since = std::optional<study::SinceChange>;

// Whether the rows since a change tell that the model is clearly better than over all rows: those
// of before judge it by another vehicle.
bool is_better_since(const study::AxisResult& axis, const Since& since) {
  return since && since->rows >= kTuning.judging_rows &&
         since->r2 > std::max(kTuning.clear_r2, axis.r2_final + kTuning.better_since);
}

// Whether rows of before the change are most of those that judge, and find the model wanting.
bool is_judged_by_before(const study::AxisResult& axis, const Since& since) {
  return since && since->before > since->rows && axis.r2_final < kTuning.good_r2;
}

// How good the predictions of an axis are, in words that follow "are".
std::string quality_of(const study::AxisResult& axis, const Since& since, bool caveat) {
  if (is_better_since(axis, since)) {
    return fmt::format("{} since {} s (R² {})", quality(since->r2, caveat),
                       chart::time_text(since->since_s), chart::decimal(since->r2));
  }
  const double r2 = axis.r2_final;
  if (std::isfinite(r2) && is_judged_by_before(axis, since)) {
    return fmt::format("{} on rows mostly of before {} s", quality_of(axis, std::nullopt, caveat),
                       chart::time_text(since->since_s));
  }
  if (!std::isfinite(r2)) {
    return "not measured";
  }
  if (r2 <= kTuning.clear_r2) {
    return r2 < -kTuning.clear_r2 ? "worse than the mean" : "no better than the mean";
  }
  return quality(r2, caveat);
}

// Whether least squares is as good without the commands. Not where least squares fails with the
// commands and the model, which has them, is ahead of both.
bool commands_say_nothing(const study::AxisResult& axis) {
  const double with = axis.baselines.least_squares.r2_final;
  const double without = axis.baselines.without_commands.r2_final;
  const bool fails =
      with < without - kTuning.clear_r2 && axis.r2_final > without + kTuning.clear_r2;
  return std::isfinite(without) && !fails &&
         at_least_mean(with) <= at_least_mean(without) + kTuning.clear_r2;
}

std::string learned_line(const study::StreamResult& result) {
  const std::string log = chart::file_names(result.source);
  std::string text = fmt::format("Learned {} rows of {}", chart::grouped(result.samples_shown),
                                 chart::shortened(log, kTuning.longest_log));
  if (result.rate_hz > 0.0) {
    const double minutes = static_cast<double>(result.samples_shown) / result.rate_hz / kMinute;
    text += minutes >= 1.0
                ? fmt::format(" ({:.0f} min at {:.3g} Hz)", minutes, result.rate_hz)
                : fmt::format(" ({:.0f} s at {:.3g} Hz)", minutes * kMinute, result.rate_hz);
  }
  if (static_cast<double>(result.rows_skipped) >
      kTuning.told_skipped * static_cast<double>(result.rows_read)) {
    text += fmt::format("; {} of {} rows lack a value and are left out",
                        chart::grouped(result.rows_skipped), chart::grouped(result.rows_read));
  }
  if (result.interrupted) {
    text += fmt::format("; interrupted, {} rows are left",
                        chart::grouped(result.training_rows - result.samples_shown));
  }
  return text + "\n";
}

// Whether a named cause tells the same change already.
bool is_named(const study::ChangeFound& change, std::span<const Finding> findings) {
  return change.recalled == 0 && change.withdrawn == 0 &&
         std::ranges::any_of(findings, [&](const Finding& finding) {
           return finding.state == FindingState::named &&
                  std::abs(finding.since_s - change.since_s) <= kTuning.same_change_s;
         });
}

// The setting that names the velocity of every target: in full where the targets are called as
// derivatives of inputs.
std::string states_advice(const study::StreamResult& result) {
  std::vector<std::string> states;
  for (const study::AxisResult& axis : result.axes) {
    for (const std::string_view name : differentiated(axis.name)) {
      if (std::ranges::find(result.input_names, name) != result.input_names.end()) {
        states.emplace_back(name);
        break;
      }
    }
  }
  return states.size() == result.axes.size() && !states.empty()
             ? "--set states=" + join_text(states, ",")
             : "--set states=… names one per target";
}

// Changes without a named cause, a line for all axes with a change of one kind at one time.
std::vector<std::string> model_lines(const study::StreamResult& result) {
  using Kind = std::tuple<double, bool, bool>;  // since when, of a past model, taken back
  std::map<Kind, std::vector<std::string>> axes;
  for (const study::AxisResult& axis : result.axes) {
    for (const study::ChangeFound& change : axis.changes) {
      if (!is_named(change, result.diagnosis.findings)) {
        axes[{change.since_s, change.recalled > 0, change.withdrawn > 0}].push_back(
            report::name_of(axis));
      }
    }
  }
  std::vector<std::string> lines;
  for (const auto& [kind, names] : axes) {
    const auto [since_s, recalled, withdrawn] = kind;
    lines.push_back(fmt::format("since {} s: {} of {} {}{}", chart::time_text(since_s),
                                recalled ? "a past model" : "another model", join_text(names, ", "),
                                recalled ? "fits again" : "fits",
                                withdrawn ? " (taken back later)" : ""));
  }
  return lines;
}

}  // namespace

chart::Facts input_facts(const study::StreamResult& result) {
  const Attitude attitude = find_attitude(result.input_names);
  std::vector<std::string> commands;
  std::vector<std::string> angles;
  std::vector<std::string> velocities;
  for (std::size_t i = 0; i < result.input_names.size(); ++i) {
    const std::string& name = result.input_names[i];
    const bool command = std::ranges::find(result.commands, name) != result.commands.end();
    (attitude.contains(i) ? angles : command ? commands : velocities).push_back(name);
  }
  const bool known = !result.commands.empty();
  chart::Facts facts{{known ? "velocities" : "inputs", join_text(velocities, ", ")}};
  if (!angles.empty()) {
    facts.emplace_back("attitude", join_text(angles, ", "));
  }
  if (known) {
    Alignment told = result.alignment.alignment;
    told.water = {};
    const bool acts = !told.none();
    facts.emplace_back("commands",
                       join_text(commands, ", ") + (acts ? "; " + told.text(result.rate_hz) : ""));
  }
  if (!result.current.current.none()) {
    facts.emplace_back("velocities are through the water", result.current.current.text());
  }
  return facts;
}

chart::TextTable quality_table(const study::StreamResult& result) {
  chart::TextTable table{.title = fmt::format("R² on {} held-out rows ({})",
                                              chart::grouped(result.held_out_rows), result.split),
                         .head = {"axis", "kelpie", "least squares", "without commands", "verdict"},
                         .rows = {},
                         .left = {0, 4},
                         .whole = true};
  const bool caveat = !caveat_lines(result).empty();
  bool tells_since = false;
  for (const study::AxisResult& axis : result.axes) {
    const study::Baselines& beside = axis.baselines;
    const Since since = study::since_change(result, axis);
    tells_since = tells_since || is_better_since(axis, since);
    table.rows.push_back({report::name_of(axis), chart::decimal(axis.r2_final),
                          chart::decimal(beside.least_squares.r2_final),
                          chart::decimal(beside.without_commands.r2_final),
                          verdict_of(axis, since, caveat)});
  }
  if (tells_since) {
    table.notes.emplace_back(
        "The columns also count held-out rows of before the change, of another vehicle.");
  }
  return table;
}

std::vector<std::string> vehicle_lines(const study::StreamResult& result) {
  std::vector<std::string> lines = study::finding_lines(result);
  std::ranges::move(model_lines(result), std::back_inserter(lines));
  if (lines.empty()) {
    std::string line = "no change of the vehicle was found";
    if (!result.diagnosis.why_not.empty()) {
      line +=
          "; causes are not looked for, since it is not known which velocity belongs to which "
          "target: " +
          states_advice(result);
    } else if (!result.diagnosis.has_reference) {
      line +=
          "; the log is too short for causes, which are told by comparison with the first minutes";
    }
    lines.push_back(std::move(line));
  }
  if (lines.size() > kTuning.most_changes) {
    const std::size_t more = lines.size() - kTuning.most_changes;
    lines.resize(kTuning.most_changes);
    lines.push_back(fmt::format("and {} more", more));
  }
  return lines;
}

std::vector<std::string> warning_lines(const study::StreamResult& result) {
  std::vector<std::string> lines;
  const auto all = [&](auto is_so) {
    return !result.axes.empty() && std::ranges::all_of(result.axes, is_so);
  };
  if (all([](const study::AxisResult& axis) { return !axis.status.ready; })) {
    lines.emplace_back("nothing was learned: the log has too few rows for a scale");
  } else if (all([](const study::AxisResult& axis) { return commands_say_nothing(axis); })) {
    lines.emplace_back(
        "these commands do not move this vehicle: least squares predicts as well without the "
        "commands. Are the commands the right columns, at the right times?");
  }
  return lines;
}

std::vector<std::string> caveat_lines(const study::StreamResult& result) {
  std::vector<std::string> lines;
  const auto measured = [](const study::AxisResult& axis) { return std::isfinite(axis.r2_final); };
  if (std::ranges::none_of(result.axes, measured)) {
    return lines;
  }
  const Attitude attitude = find_attitude(result.input_names);
  std::size_t motion = 0;
  for (std::size_t i = 0; i < result.input_names.size(); ++i) {
    motion += velocity_axis(result.input_names[i]) || attitude.contains(i) ? 1 : 0;
  }
  if (result.commands.empty() && motion == result.input_names.size()) {
    lines.emplace_back(
        "no commands are among the inputs: this model cannot tell what thrusters do");
  }
  for (const std::string& answer : result.answers) {
    lines.push_back("the answer is among the inputs: " + answer);
  }
  if (result.judging_memories < kTuning.least_memories) {
    lines.push_back(fmt::format(
        "R² says little of other drives: velocities keep {:.2g} s in memory, and the held-out "
        "stretches have {:.0f} times as much in all, where {:.0f} tell",
        result.memory_s, result.judging_memories, kTuning.least_memories));
  }
  return lines;
}

bool is_poor(const study::StreamResult& result) {
  return !warning_lines(result).empty() ||
         std::ranges::all_of(result.axes, [&](const study::AxisResult& axis) {
           return axis.r2_final <= kTuning.clear_r2 &&
                  !is_better_since(axis, study::since_change(result, axis));
         });
}

std::string verdict_of(const study::AxisResult& axis,
                       const std::optional<study::SinceChange>& since, bool caveat) {
  std::string quality = quality_of(axis, since, caveat);
  if (!(axis.r2_final > kTuning.clear_r2) || is_better_since(axis, since)) {
    return quality;
  }
  const double behind = axis.baselines.least_squares.r2_final - axis.r2_final;
  if (behind > kTuning.clear_r2) {
    return fmt::format("{}; least squares is better by {:.2f}", quality, behind);
  }
  return quality +
         (commands_say_nothing(axis) ? "; the commands say nothing to least squares" : "");
}

std::string quality_sentence(const study::StreamResult& result) {
  std::vector<std::string> words;
  std::vector<std::vector<std::string>> axes;
  const bool caveat = !caveat_lines(result).empty();
  for (const study::AxisResult& axis : result.axes) {
    const std::string quality = quality_of(axis, study::since_change(result, axis), caveat);
    const auto found = std::ranges::find(words, quality);
    const auto place = static_cast<std::size_t>(found - words.begin());
    if (found == words.end()) {
      words.push_back(quality);
      axes.emplace_back();
    }
    axes[place].push_back(report::name_of(axis));
  }
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += fmt::format("{} {} {}{}", i == 0 ? "Predictions of" : ", of", chart::list_text(axes[i]),
                        i == 0 ? "are " : "", words[i]);
  }
  return text;
}

std::string headline(const study::StreamResult& result) {
  if (const std::vector<std::string> warnings = warning_lines(result); !warnings.empty()) {
    return warnings.front();
  }
  if (const std::vector<std::string> caveats = caveat_lines(result); !caveats.empty()) {
    return caveats.front();
  }
  const std::vector<Finding>& findings = result.diagnosis.findings;
  const auto named = std::find_if(findings.rbegin(), findings.rend(), [](const Finding& finding) {
    return finding.state == FindingState::named;
  });
  if (named == findings.rend()) {
    return quality_sentence(result);
  }
  const std::vector<std::string> targets = study::target_names(result);
  return fmt::format("{} since {:.0f} s", finding_text(*named, {result.input_names, targets}),
                     named->since_s);
}

std::string verdict_text(const study::StreamResult& result) {
  std::string text = learned_line(result);
  for (const auto& [kind, inputs] : input_facts(result)) {
    text += line(kind + ": " + inputs);
  }
  text += "\n" + chart::table_text(quality_table(result));
  for (const std::string& change : vehicle_lines(result)) {
    text += line("vehicle: " + change);
  }
  for (const auto& warnings : {warning_lines(result), caveat_lines(result)}) {
    for (const std::string& warning : warnings) {
      text += line("WARNING: " + warning);
    }
  }
  return text;
}

}  // namespace kelpie::report
