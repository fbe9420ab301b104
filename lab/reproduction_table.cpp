// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <vector>

#include "chart/wording.hpp"
#include "lab/claims.hpp"
#include "lab/reproduction_report.hpp"
#include "lab/reproduction_views.hpp"

namespace kelpie::lab {
namespace {

constexpr std::size_t kNameWidth = 28;

std::string cells(const std::string& name, const std::vector<double>& values) {
  std::string text = fmt::format("  {}{:{}}", name, "",
                                 kNameWidth - std::min(kNameWidth, chart::code_points(name)));
  for (const double value : values) {
    const std::string cell = chart::decimal(value);
    text +=
        fmt::format("{:{}}{}", "", 9 - std::min<std::size_t>(8, chart::code_points(cell)), cell);
  }
  return text + "\n";
}

std::string study_text(const StreamStudy& study) {
  std::string text = fmt::format("{}, {}: R² at the end of each configuration, mean of the axes\n",
                                 study.key, study.split);
  std::vector<double> level;
  for (std::size_t stage = 0; stage < stages_of(study) && !study.offline.empty(); ++stage) {
    level.push_back(mean_baseline_r2(study, stage));
  }
  if (!level.empty()) {
    text += cells("off-line baseline", level);
  }
  for (const ContenderRuns& runs : study.contenders) {
    std::vector<double> values;
    for (std::size_t stage = 0; stage < stages_of(study); ++stage) {
      values.push_back(mean_stage_r2(runs, stage));
    }
    text += cells(runs.name, values);
  }
  return text + "\n";
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
                    "claims of the paper, each on each stream and split: {} hold, {} hold "
                    "in part, {} do not hold, {} could not be judged\n",
                    counts[0], counts[1], counts[2], counts[3]);
}

}  // namespace kelpie::lab
