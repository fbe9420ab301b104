// SPDX-License-Identifier: Apache-2.0
#include "lab/diagnosis_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "chart/figure.hpp"
#include "chart/page.hpp"
#include "core/quantile.hpp"
#include "file/json.hpp"
#include "kelpie/motion/diagnosis.hpp"

namespace kelpie::lab {
namespace {

using file::Json;

std::string share_text(std::size_t part, std::size_t all) {
  return all > 0
             ? fmt::format("{:.0f} %", 100.0 * static_cast<double>(part) / static_cast<double>(all))
             : "–";
}

chart::TextTable case_table(const DiagnosisStudy& study) {
  chart::TextTable table{
      .title = fmt::format("One change, {:.0f} s after it", study.after_s),
      .head = {"case", "effect", "right", "wrong\nname", "named after\nmedian", "longest",
               "interval\nholds"},
      .rows = {},
      .notes = {fmt::format("Simulated vehicle, seeds {} to {}. Right: what was named is what it "
                            "was, and nothing else. Interval: of those right.",
                            study.first_seed, study.first_seed + study.seeds - 1)}};
  const std::vector<CaseSummary> all = summaries(study);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const CaseSummary& one = all[i];
    const DiagnosisCase& of = study.cases[i];
    const bool sized = of.truth.front().kind != CauseKind::frozen;
    table.rows.push_back({of.name, of.effect > 0 ? fmt::format("{} %", of.effect) : "",
                          share_text(one.right, one.runs), std::to_string(one.wrong),
                          fmt::format("{:.0f} s", one.median_s),
                          fmt::format("{:.0f} s", one.longest_s),
                          sized ? share_text(one.held, one.right) : ""});
  }
  return table;
}

// Runs by effect: single causes only.
chart::TextTable effect_table(const DiagnosisStudy& study) {
  chart::TextTable table{.title = "Single causes by strength",
                         .head = {"effect", "runs", "right", "worst case", "interval holds"},
                         .rows = {},
                         .notes = {}};
  const std::vector<CaseSummary> all = summaries(study);
  for (const int effect : {20, 40, 60, 80}) {
    CaseSummary sum;
    std::size_t least = study.seeds;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (study.cases[i].effect == effect && !study.cases[i].special) {
        sum.runs += all[i].runs;
        sum.right += all[i].right;
        sum.held += all[i].held;
        least = std::min(least, all[i].right);
      }
    }
    table.rows.push_back({fmt::format("{} %", effect), std::to_string(sum.runs),
                          share_text(sum.right, sum.runs), share_text(least, study.seeds),
                          share_text(sum.held, sum.right)});
  }
  return table;
}

chart::TextTable nominal_table(const DiagnosisStudy& study) {
  chart::TextTable table{
      .title = "Nothing changed",
      .head = {"seed", "hours", "named", "of these taken back", "found without a name"},
      .rows = {},
      .notes = {}};
  for (const NominalRun& run : study.nominal) {
    table.rows.push_back({std::to_string(run.seed), fmt::format("{:.0f}", run.hours),
                          std::to_string(run.named), std::to_string(run.taken_back),
                          std::to_string(run.unnamed)});
  }
  return table;
}

// What it was, what was said of it.
chart::TextTable confusion_table(const DiagnosisStudy& study) {
  std::map<std::string, std::map<std::string, std::size_t>> counts;
  std::set<std::string> words;
  std::vector<std::string> names;
  for (const DiagnosisRun& run : study.runs) {
    const std::string& name = study.cases[run.of].name;
    if (!counts.contains(name)) {
      names.push_back(name);
    }
    const std::string word = said(run);
    words.insert(word);
    ++counts[name][word];
  }
  chart::TextTable table{.title = "What it was (rows), what was said (columns)",
                         .head = {"case"},
                         .rows = {},
                         .notes = {"Runs of all strengths together."}};
  table.head.insert(table.head.end(), words.begin(), words.end());
  for (const std::string& name : names) {
    std::vector<std::string>& row = table.rows.emplace_back(std::vector<std::string>{name});
    for (const std::string& word : words) {
      const std::size_t count = counts[name][word];
      row.push_back(count > 0 ? std::to_string(count) : "");
    }
  }
  return table;
}

double neutral(CauseKind kind) {
  return kind == CauseKind::force || kind == CauseKind::sensor_bias ? 0.0 : 1.0;
}

// The change that was told as a share of the true one, by its strength.
std::string size_figure(const DiagnosisStudy& study) {
  chart::Figure figure({"effect in %", {}}, {"told in % of the truth", {}},
                       "sizes told, over the strength of the change");
  for (std::size_t kind = 0; kind < kCauseKinds; ++kind) {
    std::vector<chart::Point> points;
    for (const DiagnosisRun& run : study.runs) {
      const DiagnosisCase& of = study.cases[run.of];
      const Cause& truth = of.truth.front();
      if (static_cast<std::size_t>(truth.kind) != kind || of.effect == 0 || of.special ||
          !named_rightly(of, run) || run.finding.causes[0].place != truth.place) {
        continue;
      }
      const double zero = neutral(truth.kind);
      const auto seed = static_cast<double>(run.seed - study.first_seed);
      points.push_back({of.effect + 2.0 * static_cast<double>(kind) - 6.0 +
                            1.6 * seed / static_cast<double>(study.seeds),
                        100.0 * (run.finding.causes[0].size - zero) / (truth.size - zero)});
    }
    if (!points.empty()) {
      std::ranges::sort(points, {}, &chart::Point::x);
      figure.dots(points, kind, std::string(kind_name(static_cast<CauseKind>(kind))));
    }
  }
  return figure.html("One point per run that was named rightly; kinds and seeds side by side.");
}

std::string delay_figure(const DiagnosisStudy& study) {
  chart::Figure figure({"time since the change in s", {}}, {"share named rightly in %", {}},
                       "share of runs with the right name, over time");
  std::size_t style = 0;
  for (const int effect : {20, 40, 60, 80}) {
    std::vector<double> delays;
    std::size_t runs = 0;
    for (const DiagnosisRun& run : study.runs) {
      const DiagnosisCase& of = study.cases[run.of];
      if (of.effect == effect && !of.special) {
        ++runs;
        if (named_rightly(of, run)) {
          delays.push_back(run.named_after_s);
        }
      }
    }
    std::ranges::sort(delays);
    std::vector<chart::Point> curve;
    for (std::size_t i = 0; i < delays.size(); ++i) {
      curve.push_back({delays[i], 100.0 * static_cast<double>(i + 1) / static_cast<double>(runs)});
    }
    figure.line(curve, style++, fmt::format("{} %", effect));
  }
  return figure.html("Single causes by strength.");
}

}  // namespace

std::vector<CaseSummary> summaries(const DiagnosisStudy& study) {
  std::vector<CaseSummary> all(study.cases.size());
  std::vector<std::vector<double>> delays(study.cases.size());
  for (const DiagnosisRun& run : study.runs) {
    const DiagnosisCase& of = study.cases[run.of];
    CaseSummary& sum = all[run.of];
    ++sum.runs;
    if (named_rightly(of, run)) {
      ++sum.right;
      sum.held += holds_truth(of, run) ? 1 : 0;
      delays[run.of].push_back(run.named_after_s);
    } else if (run.found && run.finding.state == FindingState::named) {
      ++sum.wrong;
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!delays[i].empty()) {
      all[i].longest_s = std::ranges::max(delays[i]);
      all[i].median_s = quantile(delays[i], 0.5);
    }
  }
  return all;
}

std::string diagnosis_table(const DiagnosisStudy& study) {
  std::string text;
  for (const chart::TextTable& table :
       {case_table(study), effect_table(study), nominal_table(study)}) {
    text += table.rows.empty() ? "" : chart::table_text(table);
  }
  return text;
}

std::string diagnosis_json(const DiagnosisStudy& study) {
  const Json runs = file::list(study.runs, [&](const DiagnosisRun& run) {
    const DiagnosisCase& of = study.cases[run.of];
    const Cause& told = run.finding.causes[0];
    return Json{{"case", of.name},
                {"effect", of.effect},
                {"seed", run.seed},
                {"said", said(run)},
                {"right", named_rightly(of, run)},
                {"holds", holds_truth(of, run)},
                {"found_after_s", run.found_after_s},
                {"named_after_s", run.named_after_s},
                {"truth", of.truth.front().size},
                {"size", told.size},
                {"lower", told.lower},
                {"upper", told.upper}};
  });
  const Json nominal = file::list(study.nominal, [](const NominalRun& run) {
    return Json{{"seed", run.seed},
                {"hours", run.hours},
                {"named", run.named},
                {"taken_back", run.taken_back},
                {"unnamed", run.unnamed}};
  });
  return file::json_text({{"format", "kelpie-diagnosis"},
                          {"seeds", study.seeds},
                          {"first_seed", study.first_seed},
                          {"after_s", study.after_s},
                          {"runs", runs},
                          {"nominal", nominal}});
}

std::string diagnosis_html(const DiagnosisStudy& study) {
  const std::string opening =
      chart::heading(1, "What changed?") +
      chart::paragraph("lead", "A simulated vehicle changes, and the diagnosis says what.");
  return chart::html_page(
      "kelpie: diagnosis", opening,
      {{"By strength", chart::html_table(effect_table(study)) + delay_figure(study)},
       {"Sizes", size_figure(study)},
       {"Every case", chart::html_table(case_table(study))},
       {"Confusion", chart::html_table(confusion_table(study))},
       {"Without a change", chart::html_table(nominal_table(study))}});
}

}  // namespace kelpie::lab
