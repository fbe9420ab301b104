// SPDX-License-Identifier: Apache-2.0
#include "report/tune_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "chart/wording.hpp"
#include "format/json_parts.hpp"
#include "format/settings_toml.hpp"
#include "kelpie/core/text.hpp"

namespace kelpie::report {
namespace {

constexpr std::string_view kPaper = "paper";
constexpr std::array<std::string_view, 8> kTableOne{"epsilon", "c", "gamma", "buffer",
                                                    "k",       "a", "b",     "xi"};
constexpr std::size_t kNameWidth = 16;
constexpr std::size_t kCellWidth = 10;

// A setting's values, one per axis.
std::vector<std::string> per_axis(const std::string& text, std::size_t axes) {
  std::vector<std::string> values = split_text(text, ',');
  values.resize(axes, values.front());
  return values;
}

std::string row(const std::string& name, const std::vector<std::string>& cells) {
  std::string text = fmt::format("{:<{}}", chart::shortened(name, kNameWidth - 1), kNameWidth);
  for (const std::string& cell : cells) {
    text += fmt::format(" {:>{}}", chart::shortened(cell, kCellWidth), kCellWidth);
  }
  return text + "\n";
}

std::vector<std::string> names_of(const study::TuneResult& result) {
  std::vector<std::string> names;
  names.reserve(result.axes.size());
  for (const study::TunedAxis& axis : result.axes) {
    names.push_back(axis.name);
  }
  return names;
}

const ModelSettings* paper(const study::TuneResult& result) {
  for (const auto& [name, settings] : result.references) {
    if (name == kPaper) {
      return &settings;
    }
  }
  return nullptr;
}

// The head over one or two groups of axes.
std::string head(const study::TuneResult& result, bool beside_paper) {
  const std::vector<std::string> names = names_of(result);
  std::vector<std::string> columns = names;
  const std::size_t group = names.size() * (kCellWidth + 1);
  std::string text = fmt::format("{:<{}}{:>{}}", "", kNameWidth, "tuned", group);
  if (beside_paper) {
    columns.insert(columns.end(), names.begin(), names.end());
    text += fmt::format("{:>{}}", "paper (Table I)", group);
  }
  return text + "\n" + row("", columns);
}

// The settings of Table I, then the others in which the two differ.
std::string values_table(const study::TuneResult& result) {
  const std::size_t axes = result.axes.size();
  const ModelSettings* const other = paper(result);
  const auto ours = result.tuned.values();
  const auto theirs = (other == nullptr ? result.tuned : *other).values();
  const auto line = [&](std::size_t i) {
    std::vector<std::string> cells = per_axis(ours[i].second, axes);
    if (other != nullptr) {
      const std::vector<std::string> more = per_axis(theirs[i].second, axes);
      cells.insert(cells.end(), more.begin(), more.end());
    }
    return row(ours[i].first, cells);
  };
  std::string text = head(result, other != nullptr);
  for (const std::string_view name : kTableOne) {
    const auto found = std::ranges::find(
        ours, name, [](const auto& value) { return std::string_view(value.first); });
    text += line(static_cast<std::size_t>(found - ours.begin()));
  }
  for (std::size_t i = 1; i < ours.size(); ++i) {
    if (std::ranges::find(kTableOne, ours[i].first) == kTableOne.end() && ours[i] != theirs[i]) {
      text += line(i);
    }
  }
  return text;
}

std::string scores_table(const study::TuneResult& result) {
  std::string text = row("score", names_of(result));
  for (std::size_t i = 0; i < result.references.size(); ++i) {
    std::vector<std::string> cells;
    cells.reserve(result.axes.size());
    for (const study::TunedAxis& axis : result.axes) {
      cells.push_back(chart::decimal(axis.references[i]));
    }
    text += row(result.references[i].first, cells);
  }
  std::vector<std::string> cells;
  for (const study::TunedAxis& axis : result.axes) {
    // Scores of a shorter rung don't compare with those above.
    const bool last = axis.rung + 1 == result.rungs.size();
    cells.push_back(chart::decimal(last ? axis.score : NAN));
  }
  return text + row("tuned", cells);
}

std::string given_up_text(const study::TuneResult& result) {
  const auto given_up = std::ranges::count_if(
      result.evaluations, [](const study::Evaluation& one) { return one.result.given_up; });
  return fmt::format("{} evaluations; given up, since the solver needed too many iterations: {}\n",
                     result.evaluations.size(), given_up);
}

format::Json tuned_axis_json(const study::TuneResult& result, const study::TunedAxis& axis) {
  format::Json references = format::Json::object();
  for (std::size_t i = 0; i < result.references.size(); ++i) {
    references[result.references[i].first] = format::number(axis.references[i]);
  }
  return {{"name", axis.name},
          {"score", format::number(axis.score)},
          {"rung", axis.rung},
          {"references", references}};
}

format::Json evaluation_json(const study::Evaluation& one) {
  format::Json stretches = format::Json::array();
  for (const double stretch : one.result.stretches) {
    stretches.push_back(format::number(stretch));
  }
  return {{"axis", one.key.axis},           {"rung", one.key.rung},
          {"settings", one.key.settings},   {"score", format::number(one.result.score)},
          {"stretches", stretches},         {"iterations_per_row", one.result.iterations_per_row},
          {"given_up", one.result.given_up}};
}

format::Json rung_json(const study::Rung& rung) {
  format::Json windows = format::Json::array();
  for (const study::Window& window : rung.windows) {
    windows.push_back(
        {{"begin", window.begin}, {"judged_from", window.judged_from}, {"end", window.end}});
  }
  return {{"rows", rung.rows}, {"windows", windows}};
}

}  // namespace

std::string tune_table(const study::TuneResult& result) {
  return values_table(result) + "\n" + scores_table(result) + "\n" + given_up_text(result);
}

std::string tune_json(const study::TuneResult& result, const study::TuneJournal::Header& header) {
  format::Json search = format::Json::object();
  for (const auto& [name, value] : header) {
    search[name] = value;
  }
  format::Json tuned = format::Json::object();
  for (const auto& [name, value] : result.tuned.values()) {
    tuned[name] = value;
  }
  const auto axis = [&](const study::TunedAxis& one) { return tuned_axis_json(result, one); };
  const format::Json document = {
      {"format", "kelpie-tune"},
      {"version", 1},
      {"search", search},
      {"interrupted", result.interrupted},
      {"tuned", tuned},
      {"axes", format::list(result.axes, axis)},
      {"rungs", format::list(result.rungs, rung_json)},
      {"evaluations", format::list(result.evaluations, evaluation_json)}};
  return format::json_text(document);
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
