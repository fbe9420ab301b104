// SPDX-License-Identifier: Apache-2.0
#include "report/tune_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>

#include "chart/wording.hpp"
#include "format/settings_toml.hpp"
#include "kelpie/core/text.hpp"

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
      "Least squares and mean are baselines on the same rows (docs/baselines.md)."};
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
      list.push_back({log, axis, scores.tuned - scores.base});
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
      logs.size(), result.logs.size(), chart::printable(result.logs[most.log].name),
      chart::printable(result.axes[most.axis].name), chart::decimal(scores.tuned),
      chart::decimal(scores.base));
}

std::string tuned_toml(const study::TuneResult& result, const study::TuneJournal::Header& header) {
  std::string text = "# Found by `kelpie tune`.\n";
  if (result.interrupted) {
    text += "# The search was interrupted: these are the best values it had found by then.\n";
  }
  for (const auto& [name, value] : header) {
    text += fmt::format("# {}: {}\n", name, chart::printable(value));
  }
  for (const study::TunedAxis& axis : result.axes) {
    text += fmt::format("# {}: score {} on rung {} of {}", chart::printable(axis.name),
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

}  // namespace kelpie::report
