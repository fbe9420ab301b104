// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "kelpie/core/text.hpp"
#include "report/tune_report.hpp"

namespace kelpie::report {
namespace {

constexpr double kHardlyLess = 0.005;  // of the score
constexpr std::size_t kMostRows = 12;

using study::Evaluation;

// Those of an axis that were judged on a rung, the best first.
std::vector<const Evaluation*> judged(const study::TuneResult& result, const std::string& axis,
                                      std::size_t rung) {
  std::vector<const Evaluation*> found;
  for (const Evaluation& one : result.evaluations) {
    if (one.key.axis == axis && one.key.rung == rung && std::isfinite(one.result.score)) {
      found.push_back(&one);
    }
  }
  std::ranges::stable_sort(found, std::greater<>{},
                           [](const Evaluation* one) { return one->result.score; });
  return found;
}

// The least work among those whose score is hardly less than the best's.
const Evaluation* cheapest(const std::vector<const Evaluation*>& best_first) {
  const Evaluation* least = best_first.front();
  for (const Evaluation* one : best_first) {
    if (one->result.score >= best_first.front()->result.score - kHardlyLess &&
        one->result.iterations_per_row < least->result.iterations_per_row) {
      least = one;
    }
  }
  return least;
}

// A candidate's settings without those that all have.
std::string own_settings(const Evaluation& one, const std::vector<const Evaluation*>& all) {
  std::vector<std::string> words = split_text(one.key.settings, ' ');
  std::erase_if(words, [&](const std::string& word) {
    return all.size() > 1 && std::ranges::all_of(all, [&](const Evaluation* other) {
             return std::ranges::count(split_text(other->key.settings, ' '), word) > 0;
           });
  });
  return join_text(words, ", ");
}

std::string advice(const study::TunedAxis& axis, const std::vector<const Evaluation*>& best_first) {
  const Evaluation& best = *best_first.front();
  const Evaluation& least = *cheapest(best_first);
  std::string text = fmt::format("{}: the best scores {} with {} iterations of the solver per row",
                                 chart::shortened(axis.name, chart::kLongestName),
                                 chart::decimal(best.result.score),
                                 chart::significant(best.result.iterations_per_row));
  return text + (&least == &best
                     ? "; none that scores nearly as much takes less."
                     : fmt::format("; {} scores {} with {}.", own_settings(least, best_first),
                                   chart::decimal(least.result.score),
                                   chart::significant(least.result.iterations_per_row)));
}

std::string candidates_figure(const study::TuneResult& result, const study::TunedAxis& axis) {
  chart::Figure figure({"iterations of the solver per row", {}, chart::ScaleKind::logarithmic},
                       {"score"},
                       axis.name + ": candidates by their score and by the solver's work");
  std::size_t given_up = 0;
  for (std::size_t rung = 0; rung < result.rungs.size(); ++rung) {
    std::vector<chart::Point> points;
    for (const Evaluation* one : judged(result, axis.name, rung)) {
      points.push_back(
          {std::max(one->result.iterations_per_row, 1e-3), std::max(one->result.score, -0.2)});
    }
    std::ranges::stable_sort(points, {}, &chart::Point::x);
    figure.markers(points, rung, fmt::format("judged on {} rows", result.rungs[rung].rows));
  }
  for (const Evaluation& one : result.evaluations) {
    given_up += one.key.axis == axis.name && one.result.given_up ? 1 : 0;
  }
  return figure.html(fmt::format(
      "Work and time grow together. Scores below −0.2 are drawn there. Given up: {}.", given_up));
}

chart::TextTable best_table(const std::vector<const Evaluation*>& best_first) {
  chart::TextTable table{{}, {"settings that differ", "score", "iterations per row"}, {}};
  for (std::size_t i = 0; i < std::min(kMostRows, best_first.size()); ++i) {
    const Evaluation& one = *best_first[i];
    table.rows.push_back({own_settings(one, best_first), chart::decimal(one.result.score),
                          chart::significant(one.result.iterations_per_row)});
  }
  return table;
}

}  // namespace

std::string tune_html(const study::TuneResult& result, const study::TuneJournal::Header& header) {
  std::string opening = chart::heading(1, "Settings that learn this log best");
  if (result.interrupted) {
    opening += chart::paragraph("interrupted", "The search was interrupted: the best until then.");
  }
  std::string candidates = chart::paragraph(
      "note",
      "A setting whose score is higher by a thousandth and that takes the solver twenty times as "
      "long is no gain: look to the left of the best.");
  for (const study::TunedAxis& axis : result.axes) {
    const std::vector<const Evaluation*> best_first = judged(result, axis.name, axis.rung);
    candidates += chart::heading(3, axis.name) + candidates_figure(result, axis);
    if (!best_first.empty()) {
      opening += chart::paragraph("lead", advice(axis, best_first));
      const chart::TextTable table = best_table(best_first);
      candidates += chart::html_table(table.head, table.rows, "words");
    }
  }
  std::string tables;
  for (const chart::TextTable& table : tune_tables(result)) {
    tables += chart::heading(3, table.title) + chart::html_table(table);
  }
  return chart::html_page("kelpie: tune", opening,
                          {{"Candidates", candidates},
                           {"Chosen settings and scores", tables},
                           {"The search", chart::facts_table(header)}});
}

}  // namespace kelpie::report
