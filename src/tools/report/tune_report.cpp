// SPDX-License-Identifier: Apache-2.0
#include "report/tune_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <set>

#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "core/text.hpp"
#include "format/settings_toml.hpp"
#include "report/tuning.hpp"

namespace kelpie::report {
namespace {

constexpr std::string_view kPaper = "paper";
constexpr std::array<std::string_view, 8> kTableOne{"epsilon", "c", "gamma", "buffer",
                                                    "k",       "a", "b",     "xi"};
constexpr std::size_t kLongestValue = 10;
constexpr std::size_t kMostLogRows = 60;
constexpr double kVisible = 0.0005;  // of a score with three decimals

// A setting's values, one per axis.
std::vector<std::string> per_axis(const std::string& text, std::size_t axes) {
  std::vector<std::string> values = split_text(text, ',');
  values.resize(axes, values.front());
  return values;
}

const ModelSettings* paper(const study::TuneResult& result) {
  for (const auto& [name, settings] : result.references) {
    if (name == kPaper) {
      return &settings;
    }
  }
  return nullptr;
}

// The settings of Table I, then the others in which the two differ.
chart::TextTable values_table(const study::TuneResult& result) {
  const std::size_t axes = result.axes.size();
  const ModelSettings* const other = paper(result);
  const auto ours = result.tuned.values();
  const auto theirs = (other == nullptr ? result.tuned : *other).values();
  chart::TextTable table{
      other == nullptr ? "Tuned settings" : "Tuned settings beside the paper (Table I)", {""}, {}};
  const auto add_head = [&](const std::string& whose) {
    for (const study::TunedAxis& axis : result.axes) {
      table.head.push_back(whose + "\n" + chart::shortened(axis.name, kLongestValue));
    }
  };
  add_head("tuned");
  if (other != nullptr) {
    add_head("paper");
  }
  const auto add_row = [&](std::size_t i) {
    std::vector<std::string> cells = per_axis(ours[i].second, axes);
    if (other != nullptr) {
      const std::vector<std::string> more = per_axis(theirs[i].second, axes);
      cells.insert(cells.end(), more.begin(), more.end());
    }
    std::vector<std::string>& row = table.rows.emplace_back(1, ours[i].first);
    for (const std::string& cell : cells) {
      row.push_back(chart::shortened(cell, kLongestValue));
    }
  };
  for (const std::string_view name : kTableOne) {
    const auto found = std::ranges::find(
        ours, name, [](const auto& value) { return std::string_view(value.first); });
    add_row(static_cast<std::size_t>(found - ours.begin()));
  }
  for (std::size_t i = 1; i < ours.size(); ++i) {
    if (std::ranges::find(kTableOne, ours[i].first) == kTableOne.end() && ours[i] != theirs[i]) {
      add_row(i);
    }
  }
  return table;
}

chart::TextTable scores_table(const study::TuneResult& result) {
  const bool several = result.logs.size() > 1;
  chart::TextTable table{{}, {several ? "mean score" : "score"}, {}};
  for (const auto& [name, settings] : result.references) {
    table.rows.push_back({name});
  }
  if (several) {
    table.rows.push_back({"base"});
  }
  for (const char* const row : {"tuned", "least squares", "mean"}) {
    table.rows.push_back({row});
  }
  for (const study::TunedAxis& axis : result.axes) {
    table.head.push_back(axis.name);
    std::vector<double> scores = axis.all.references;
    if (several) {
      scores.push_back(axis.all.base);
    }
    // Scores of a shorter rung don't compare with the others.
    const bool last = axis.rung + 1 == result.rungs.size();
    scores.insert(scores.end(), {last ? axis.score : NAN, axis.all.least_squares, axis.all.mean});
    for (std::size_t i = 0; i < scores.size(); ++i) {
      table.rows[i].push_back(chart::decimal(scores[i]));
    }
  }
  const auto given_up = std::ranges::count_if(
      result.evaluations, [](const study::Evaluation& one) { return one.result.given_up; });
  table.notes = {
      fmt::format("{} evaluations; given up, since the solver needed too many iterations: {}",
                  result.evaluations.size(), given_up),
      "Least squares and mean are baselines on the same rows (docs/measured/reproduction.md)."};
  return table;
}

// A log's target, by how much the search has gained there.
struct Gain {
  std::size_t log = 0;
  std::size_t axis = 0;
  double gain = 0.0;  // NaN: not judged
};

// The smallest first.
std::vector<Gain> gains(const study::TuneResult& result) {
  std::vector<Gain> list;
  for (std::size_t log = 0; log < result.logs.size(); ++log) {
    for (std::size_t axis = 0; axis < result.axes.size(); ++axis) {
      const study::TuneScores& scores = result.axes[axis].logs[log];
      list.push_back({log, axis, scores.gain()});
    }
  }
  std::ranges::stable_sort(list, [](const Gain& a, const Gain& b) {
    return a.gain < b.gain || (std::isnan(b.gain) && !std::isnan(a.gain));
  });
  return list;
}

// The targets of logs on which the tuned settings are worse than the base, by more than a score
// with three decimals hides.
std::vector<Gain> losses(const study::TuneResult& result) {
  std::vector<Gain> list = gains(result);
  std::erase_if(list, [](const Gain& one) { return !(one.gain <= -kVisible); });
  return list;
}

// Without the folders that all of them lie in: the end of a name tells logs apart, and a table cuts
// it.
std::vector<std::string> short_names(const std::vector<study::TunedLog>& logs) {
  std::string_view shared = logs.front().name;
  for (const study::TunedLog& log : logs) {
    shared = {shared.begin(), std::ranges::mismatch(shared, log.name).in1};
  }
  const std::size_t length = shared.rfind('/') + 1;  // 0 where there is none
  std::vector<std::string> names;
  std::ranges::transform(logs, std::back_inserter(names),
                         [&](const study::TunedLog& log) { return log.name.substr(length); });
  return names;
}

chart::TextTable logs_table(const study::TuneResult& result) {
  chart::TextTable table{"Scores by log, the smallest gain first",
                         {"log", "target", "base", "tuned", "gain", "least squares", "mean"},
                         {}};
  table.left = {0, 1};
  const std::vector<Gain> list = gains(result);
  const std::vector<std::string> names = short_names(result.logs);
  for (const Gain& one : list) {
    if (table.rows.size() == kMostLogRows) {
      table.notes = {fmt::format("{} more are in tune.json.", list.size() - kMostLogRows)};
      break;
    }
    const study::TunedAxis& axis = result.axes[one.axis];
    const study::TuneScores& scores = axis.logs[one.log];
    table.rows.push_back({names[one.log], axis.name, chart::decimal(scores.base),
                          chart::decimal(scores.tuned), chart::decimal(one.gain),
                          chart::decimal(scores.least_squares), chart::decimal(scores.mean)});
  }
  return table;
}

}  // namespace

std::vector<chart::TextTable> tune_tables(const study::TuneResult& result) {
  std::vector<chart::TextTable> tables{values_table(result), scores_table(result)};
  if (result.logs.size() > 1) {
    tables.push_back(logs_table(result));
  }
  return tables;
}

std::string tune_table(const study::TuneResult& result) {
  std::string text;
  for (const chart::TextTable& table : tune_tables(result)) {
    text += chart::table_text(table);
  }
  return text;
}

std::string worse_text(const study::TuneResult& result) {
  const std::vector<Gain> list = losses(result);
  if (list.empty()) {
    return {};
  }
  std::set<std::size_t> logs;
  for (const Gain& one : list) {
    logs.insert(one.log);
  }
  const Gain& most = list.front();
  const study::TuneScores& scores = result.axes[most.axis].logs[most.log];
  return fmt::format(
      "WORSE than the settings the search started from on {} of {} logs; most on {}, {}: {} "
      "instead of {}",
      logs.size(), result.logs.size(), chart::safe_text(result.logs[most.log].name),
      chart::safe_text(result.axes[most.axis].name), chart::decimal(scores.tuned),
      chart::decimal(scores.base));
}

std::string tuned_toml(const study::TuneResult& result, const study::TuneJournal::Header& header) {
  std::string text = "# Found by `kelpie tune`.\n";
  if (result.interrupted) {
    text += "# The search was interrupted: these are the best values it had found by then.\n";
  }
  for (const auto& [name, value] : header) {
    text += fmt::format("# {}: {}\n", name, chart::safe_text(value));
  }
  for (const study::TunedAxis& axis : result.axes) {
    text += fmt::format("# {}: score {} on rung {} of {}", chart::safe_text(axis.name),
                        chart::decimal(axis.score), axis.rung + 1, result.rungs.size());
    for (std::size_t i = 0; i < result.references.size(); ++i) {
      text += fmt::format("; {} {} on the last", result.references[i].first,
                          chart::decimal(axis.all.references[i]));
    }
    text += "\n";
  }
  if (const std::string worse = worse_text(result); !worse.empty()) {
    text += "# " + worse + "\n";
  }
  return text + "\n" + format::settings_toml(result.tuned, true);
}

namespace {

constexpr double kHardlyLess = 0.005;  // of the score
constexpr double kShownBelow = 0.1;    // of the best score, in a figure
constexpr std::size_t kMostRows = 12;

using study::TrialResult;

// Those of an axis that were judged on a rung, the best first.
std::vector<const TrialResult*> judged(const study::TuneResult& result, const std::string& axis,
                                       std::size_t rung) {
  std::vector<const TrialResult*> found;
  for (const TrialResult& one : result.trials) {
    if (one.axis == axis && one.rung == rung && std::isfinite(one.score)) {
      found.push_back(&one);
    }
  }
  std::ranges::stable_sort(found, std::greater<>{},
                           [](const TrialResult* one) { return one->score; });
  return found;
}

// The least work among those whose score is hardly less than the best's.
const TrialResult* cheapest(const std::vector<const TrialResult*>& best_first) {
  const TrialResult* least = best_first.front();
  for (const TrialResult* one : best_first) {
    if (one->score >= best_first.front()->score - kHardlyLess &&
        one->iterations_per_row < least->iterations_per_row) {
      least = one;
    }
  }
  return least;
}

// A candidate by the reference that it resembles most, and what differs: "default with c=3".
std::string name_of(const TrialResult& one, const study::TuneResult& result, std::size_t axis) {
  std::string nearest;
  std::vector<std::string> different = split_text(one.settings, ' ');
  for (const auto& [name, settings] : result.references) {
    const std::vector<std::string> own = split_text(study::settings_of(settings, axis), ' ');
    std::vector<std::string> words = split_text(one.settings, ' ');
    std::erase_if(words,
                  [&](const std::string& word) { return std::ranges::count(own, word) > 0; });
    if (nearest.empty() || words.size() < different.size()) {
      nearest = name;
      different = words;
    }
  }
  return different.empty() ? nearest : nearest + " with " + join_text(different, ", ");
}

}  // namespace

bool any_gain(const study::TuneResult& result) {
  return std::ranges::any_of(result.axes,
                             [](const study::TunedAxis& axis) { return axis.all.gain() > 0.0; });
}

std::string gain_sentence(const study::TuneResult& result) {
  std::vector<std::string> gained;
  bool judged = false;
  for (const study::TunedAxis& axis : result.axes) {
    judged = judged || std::isfinite(axis.all.gain());
    if (axis.all.gain() > 0.0) {
      gained.push_back(fmt::format("{} by {}", chart::shortened(axis.name, chart::kLongestName),
                                   chart::decimal(axis.all.gain())));
    }
  }
  if (!judged) {
    return "The search ended before any settings were judged on all rows.";
  }
  return gained.empty() ? "No gain: keep the defaults. No settings drawn score clearly higher."
                        : "Tuned settings score higher: " + chart::list_text(gained) + ".";
}

namespace {

// The trial of the chosen settings on the last round; null where they were not judged there.
const TrialResult* chosen_trial(const study::TuneResult& result, std::size_t axis) {
  const study::TunedAxis& tuned = result.axes[axis];
  const std::string settings = study::settings_of(result.tuned, axis);
  for (const TrialResult* one : judged(result, tuned.name, tuned.rung)) {
    if (one->settings == settings) {
      return one;
    }
  }
  return nullptr;
}

// The presets that score higher than the tuned settings, by the mean over the axes: the search goes
// around the settings it started from, and these may have been a worse place than a preset.
std::string better_presets(const study::TuneResult& result) {
  std::vector<std::string> better;
  for (std::size_t i = 0; i < result.references.size(); ++i) {
    double sum = 0.0;
    for (const study::TunedAxis& axis : result.axes) {
      sum += axis.all.references[i] - axis.all.tuned;
    }
    if (sum > kTuning.clear_r2 * static_cast<double>(result.axes.size())) {
      better.push_back(result.references[i].first);
    }
  }
  return better.empty() ? ""
                        : "Without this search a preset scores higher than the tuned settings: " +
                              chart::list_text(better) + ".";
}

// Scores and the work of the solver before and after.
chart::TextTable gain_table(const study::TuneResult& result) {
  chart::TextTable table{
      {},
      {"axis", "start", "tuned", "gain", "least squares", "iterations\nper row", "tuned settings"},
      {},
      {"Score: each stretch of the log is predicted before it is learned; 1 less "
       "the mean squared error over the variance of the target. 1 is perfect, 0 "
       "no better than the mean. Start: the settings that the search started "
       "from. Iterations of the solver: work and time grow with them."},
      {0, 6}};
  for (std::size_t i = 0; i < result.axes.size(); ++i) {
    const study::TunedAxis& axis = result.axes[i];
    const TrialResult* const chosen = chosen_trial(result, i);
    table.rows.push_back({chart::shortened(axis.name, chart::kLongestName),
                          chart::decimal(axis.all.base), chart::decimal(axis.all.tuned),
                          chart::decimal(axis.all.gain()), chart::decimal(axis.all.least_squares),
                          chosen == nullptr ? "–" : chart::significant(chosen->iterations_per_row),
                          chosen == nullptr ? "–" : name_of(*chosen, result, i)});
  }
  return table;
}

// A candidate that hardly scores less for much less work; empty where there is none.
std::string cheaper(const study::TuneResult& result, std::size_t axis,
                    const std::vector<const TrialResult*>& best_first) {
  const TrialResult& best = *best_first.front();
  const TrialResult& least = *cheapest(best_first);
  return &least == &best
             ? ""
             : fmt::format(
                   "The candidate {} scores {} with {} iterations of the solver per row; the best, "
                   "{} "
                   "with {}.",
                   name_of(least, result, axis), chart::decimal(least.score),
                   chart::significant(least.iterations_per_row), chart::decimal(best.score),
                   chart::significant(best.iterations_per_row));
}

std::string candidates_figure(const study::TuneResult& result, const study::TunedAxis& axis) {
  const std::vector<const TrialResult*> best_first = judged(result, axis.name, axis.rung);
  const double best = best_first.empty() ? 1.0 : best_first.front()->score;
  const chart::Extent range{best - 1.05 * kShownBelow, best + 0.1 * kShownBelow};
  chart::Figure figure({"iterations of the solver per row", {}, chart::ScaleKind::logarithmic},
                       {"score", range},
                       axis.name + ": candidates by their score and by the solver's work");
  std::size_t given_up = 0;
  std::vector<chart::Point> points;
  for (const TrialResult* one : best_first) {
    points.push_back(
        {std::max(one->iterations_per_row, 1e-3), std::max(one->score, best - kShownBelow)});
  }
  std::ranges::stable_sort(points, {}, &chart::Point::x);
  figure.markers(points, 0, "judged on " + chart::grouped(result.rungs[axis.rung]) + " rows");
  for (const TrialResult& one : result.trials) {
    given_up += one.axis == axis.name && one.given_up ? 1 : 0;
  }
  return figure.html(
      fmt::format("The candidates of the last round, on the most rows; those further than {} below "
                  "the best are "
                  "drawn there. Given up in all rounds: {}.",
                  kShownBelow, given_up));
}

chart::TextTable best_table(const study::TuneResult& result, std::size_t axis,
                            const std::vector<const TrialResult*>& best_first) {
  chart::TextTable table{{}, {"settings", "score", "iterations per row"}, {}};
  for (std::size_t i = 0; i < std::min(kMostRows, best_first.size()); ++i) {
    const TrialResult& one = *best_first[i];
    table.rows.push_back({name_of(one, result, axis), chart::decimal(one.score),
                          chart::significant(one.iterations_per_row)});
  }
  return table;
}

}  // namespace

std::string tune_html(const study::TuneResult& result, const study::TuneJournal::Header& header) {
  std::string opening =
      chart::paragraph("over", result.logs.size() == 1 ? "Settings tried on " + result.logs[0].name
                                                       : "Settings tried on several logs") +
      chart::heading(1, gain_sentence(result));
  if (result.interrupted) {
    opening += chart::paragraph("interrupted", "The search was interrupted: the best until then.");
  }
  if (const std::string worse = worse_text(result); !worse.empty()) {
    opening += chart::paragraph("interrupted", worse + ".");
  }
  if (const std::string better = better_presets(result); !better.empty()) {
    opening += chart::paragraph("interrupted", better);
  }
  const chart::TextTable gained = gain_table(result);
  opening += chart::html_table(gained);
  if (any_gain(result)) {
    opening +=
        chart::command_lines({{"kelpie learn LOG --config tuned.toml",
                               "learns with the tuned settings; judge them on another log"}});
  }
  std::vector<std::string> figures;
  std::string candidates = chart::paragraph(
      "note",
      "A setting whose score is higher by a thousandth and that takes the solver twenty times as "
      "long is no gain: look to the left of the best.");
  std::string tables;
  for (std::size_t i = 0; i < result.axes.size(); ++i) {
    const study::TunedAxis& axis = result.axes[i];
    const std::vector<const TrialResult*> best_first = judged(result, axis.name, axis.rung);
    std::string text = chart::heading(3, axis.name) + candidates_figure(result, axis);
    if (!best_first.empty()) {
      const std::string less = cheaper(result, i, best_first);
      text += less.empty() ? "" : chart::paragraph("", less);
      const chart::TextTable table = best_table(result, i, best_first);
      tables += chart::heading(3, axis.name) + chart::html_table(table.head, table.rows, "words");
    }
    figures.push_back(text);
  }
  candidates += chart::panels(figures) + chart::folded("The best candidates", tables);
  study::TuneJournal::Header facts;  // without the checksum of the log's values
  std::ranges::copy_if(header, std::back_inserter(facts),
                       [](const auto& fact) { return fact.first != "values"; });
  return chart::html_page(
      "kelpie: tune", opening,
      {{"Candidates", candidates},
       {"Chosen settings and scores", chart::html_tables(tune_tables(result)), true},
       {"The search", chart::facts_table(facts), true}});
}

}  // namespace kelpie::report
