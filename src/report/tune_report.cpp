// SPDX-License-Identifier: Apache-2.0
#include "report/tune_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "chart/wording.hpp"
#include "format/settings_toml.hpp"
#include "kelpie/core/text.hpp"

namespace kelpie::report {
namespace {

constexpr std::string_view kPaper = "paper";
constexpr std::array<std::string_view, 8> kTableOne{"epsilon", "c", "gamma", "buffer",
                                                    "k",       "a", "b",     "xi"};
constexpr std::size_t kLongestValue = 10;

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
  chart::TextTable table{{}, {"score"}, {}};
  for (const auto& [name, settings] : result.references) {
    table.rows.push_back({name});
  }
  table.rows.push_back({"tuned"});
  table.rows.push_back({"least squares"});
  table.rows.push_back({"mean"});
  for (const study::TunedAxis& axis : result.axes) {
    table.head.push_back(axis.name);
    for (std::size_t i = 0; i < result.references.size(); ++i) {
      table.rows[i].push_back(chart::decimal(axis.references[i]));
    }
    // Scores of a shorter rung don't compare with those above.
    const bool last = axis.rung + 1 == result.rungs.size();
    const std::size_t below = result.references.size();
    table.rows[below].push_back(chart::decimal(last ? axis.score : NAN));
    table.rows[below + 1].push_back(chart::decimal(axis.least_squares));
    table.rows[below + 2].push_back(chart::decimal(axis.mean));
  }
  const auto given_up = std::ranges::count_if(
      result.evaluations, [](const study::Evaluation& one) { return one.result.given_up; });
  table.notes = {
      fmt::format("{} evaluations; given up, since the solver needed too many iterations: {}",
                  result.evaluations.size(), given_up),
      "Least squares and mean are yardsticks on the same rows (docs/baselines.md)."};
  return table;
}

}  // namespace

std::vector<chart::TextTable> tune_tables(const study::TuneResult& result) {
  return {values_table(result), scores_table(result)};
}

std::string tune_table(const study::TuneResult& result) {
  return chart::table_text(values_table(result)) + chart::table_text(scores_table(result));
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
                          chart::decimal(axis.references[i]));
    }
    text += "\n";
  }
  return text + "\n" + format::settings_toml(result.tuned, true);
}

}  // namespace kelpie::report
