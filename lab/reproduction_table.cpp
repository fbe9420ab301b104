// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "lab/claims.hpp"
#include "lab/reproduction_report.hpp"
#include "lab/reproduction_views.hpp"

namespace kelpie::lab {
namespace {

std::string study_text(const StreamStudy& study) {
  chart::TextTable table{
      fmt::format("{}, {}: R² at the end of each configuration, mean of the axes", study.key,
                  study.split),
      {""},
      {}};
  const auto add_row = [&](const std::string& name, auto r2_of_stage) {
    std::vector<std::string>& row = table.rows.emplace_back(1, name);
    for (std::size_t stage = 0; stage < stages_of(study); ++stage) {
      row.push_back(chart::decimal(r2_of_stage(stage)));
    }
  };
  for (std::size_t stage = 0; stage < stages_of(study); ++stage) {
    table.head.push_back(fmt::format("{}", stage + 1));
  }
  if (!study.offline.empty()) {
    add_row("off-line baseline", [&](std::size_t stage) { return mean_baseline_r2(study, stage); });
  }
  for (const ContenderRuns& runs : study.contenders) {
    add_row(runs.name, [&](std::size_t stage) { return mean_stage_r2(runs, stage); });
  }
  return chart::table_text(table);
}

}  // namespace

std::string reproduction_table(const Reproduction& result) {
  std::string text;
  for (const StreamStudy& study : result.studies) {
    text += study_text(study);
  }
  for (const PublishedRun& run : result.published) {
    text += fmt::format("published protocol, buffer {}: {} mean {}, minimum {}, end {}\n",
                        kPublishedBuffer, run.name, chart::decimal(run.mean),
                        chart::decimal(run.minimum), chart::decimal(run.end));
  }
  std::array<std::size_t, 4> counts{};
  for (const Claim& claim : claims_of(result)) {
    ++counts.at(static_cast<std::size_t>(claim.finding));
  }
  return text + fmt::format(
                    "claims of the paper, each on each stream and split:\n"
                    "{} hold, {} hold in part, {} do not hold, {} could not be judged\n",
                    counts[0], counts[1], counts[2], counts[3]);
}

}  // namespace kelpie::lab
