// SPDX-License-Identifier: Apache-2.0
#include "lab/diagnosis_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

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
  return chart::tables_text({case_table(study), effect_table(study), nominal_table(study)});
}

std::string diagnosis_json(const DiagnosisStudy& study) {
  const Json runs = file::list(study.runs, [&](const DiagnosisRun& run) {
    const DiagnosisCase& of = study.cases[run.of];
    const Cause& told = run.finding.causes[0];
    return Json{{"case", of.name},
                {"kind", kind_name(of.truth.front().kind)},
                {"effect", of.effect},
                {"special", of.special},
                {"seed", run.seed},
                {"said", said(run)},
                {"right", named_rightly(of, run)},
                {"same_place", told.place == of.truth.front().place},
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

}  // namespace kelpie::lab
