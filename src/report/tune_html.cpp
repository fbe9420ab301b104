// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "kelpie/core/text.hpp"
#include "report/tune_report.hpp"

namespace kelpie::report {
namespace {

constexpr double kHardlyLess = 0.005;  // of the score
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

std::string advice(const study::TuneResult& result, std::size_t axis,
                   const std::vector<const TrialResult*>& best_first) {
  const TrialResult& best = *best_first.front();
  const TrialResult& least = *cheapest(best_first);
  std::string text = fmt::format(
      "{}: best is {}, which scores {} with {} iterations of the solver per row",
      chart::shortened(result.axes[axis].name, chart::kLongestName), name_of(best, result, axis),
      chart::decimal(best.score), chart::significant(best.iterations_per_row));
  return text + (&least == &best
                     ? "; none that scores nearly as much takes less."
                     : fmt::format("; {} scores {} with {}.", name_of(least, result, axis),
                                   chart::decimal(least.score),
                                   chart::significant(least.iterations_per_row)));
}

std::string candidates_figure(const study::TuneResult& result, const study::TunedAxis& axis) {
  chart::Figure figure({"iterations of the solver per row", {}, chart::ScaleKind::logarithmic},
                       {"score"},
                       axis.name + ": candidates by their score and by the solver's work");
  std::size_t given_up = 0;
  for (std::size_t rung = 0; rung < result.rungs.size(); ++rung) {
    std::vector<chart::Point> points;
    for (const TrialResult* one : judged(result, axis.name, rung)) {
      points.push_back({std::max(one->iterations_per_row, 1e-3), std::max(one->score, -0.2)});
    }
    std::ranges::stable_sort(points, {}, &chart::Point::x);
    figure.markers(points, rung, "judged on " + chart::grouped(result.rungs[rung]) + " rows");
  }
  for (const TrialResult& one : result.trials) {
    given_up += one.axis == axis.name && one.given_up ? 1 : 0;
  }
  return figure.html(fmt::format(
      "Work and time grow together. Scores below −0.2 are drawn there. Given up: {}.", given_up));
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
      chart::heading(1, result.logs.size() == 1 ? "Settings that learn this log best"
                                                : "Settings that learn these logs best");
  if (result.interrupted) {
    opening += chart::paragraph("interrupted", "The search was interrupted: the best until then.");
  }
  if (const std::string worse = worse_text(result); !worse.empty()) {
    opening += chart::paragraph("interrupted", worse + ".");
  }
  std::string candidates = chart::paragraph(
      "note",
      "A setting whose score is higher by a thousandth and that takes the solver twenty times as "
      "long is no gain: look to the left of the best.");
  for (std::size_t i = 0; i < result.axes.size(); ++i) {
    const study::TunedAxis& axis = result.axes[i];
    const std::vector<const TrialResult*> best_first = judged(result, axis.name, axis.rung);
    candidates += chart::heading(3, axis.name) + candidates_figure(result, axis);
    if (!best_first.empty()) {
      opening += chart::paragraph("lead", advice(result, i, best_first));
      const chart::TextTable table = best_table(result, i, best_first);
      candidates += chart::html_table(table.head, table.rows, "words");
    }
  }
  study::TuneJournal::Header facts;  // without the checksum of the log's values
  std::ranges::copy_if(header, std::back_inserter(facts),
                       [](const auto& fact) { return fact.first != "values"; });
  return chart::html_page("kelpie: tune", opening,
                          {{"Candidates", candidates},
                           {"Chosen settings and scores", chart::html_tables(tune_tables(result))},
                           {"The search", chart::facts_table(facts)}});
}

}  // namespace kelpie::report
