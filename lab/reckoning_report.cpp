// SPDX-License-Identifier: Apache-2.0
#include "lab/reckoning_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>

#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "core/quantile.hpp"
#include "file/json.hpp"

namespace kelpie::lab {
namespace {

double error_quantile(const OutageScore& score, double share) {
  std::vector<double> errors = score.errors;
  return errors.empty() ? std::numeric_limits<double>::quiet_NaN() : quantile(errors, share);
}

double inside_share(const OutageScore& score) {
  return score.told == 0 ? std::numeric_limits<double>::quiet_NaN()
                         : static_cast<double>(score.inside) / static_cast<double>(score.told);
}

std::string result_title(const ReckoningResult& result) {
  return fmt::format("{}{}, {} rows held out ({}), yaw rate {}", result.source,
                     result.simulated ? " (simulation)" : "", chart::grouped(result.held_out),
                     result.split, result.yaw_rate ? "measured" : "not measured either");
}

chart::TextTable result_table(const ReckoningResult& result) {
  chart::TextTable table{result_title(result), {"error over distance: median (95 %)"}, {}};
  for (const OutageScore& score : result.scores.front().outages) {
    table.head.push_back(fmt::format("{:g} s", score.seconds));
  }
  std::vector<std::string>& counts = table.rows.emplace_back(1, "outages");
  for (const OutageScore& score : result.scores.front().outages) {
    counts.push_back(chart::grouped(score.errors.size()));
  }
  for (const NavigatorScore& navigator : result.scores) {
    std::vector<std::string>& row = table.rows.emplace_back(1, navigator.name);
    for (const OutageScore& score : navigator.outages) {
      row.push_back(score.errors.empty()
                        ? "–"
                        : fmt::format("{} ({})", chart::decimal(error_quantile(score, 0.5)),
                                      chart::decimal(error_quantile(score, 0.95))));
    }
  }
  for (const NavigatorScore& navigator : result.scores) {
    if (navigator.outages.front().told > 0) {
      std::vector<std::string>& row = table.rows.emplace_back(1, "within 90 %: " + navigator.name);
      for (const OutageScore& score : navigator.outages) {
        row.push_back(chart::decimal(inside_share(score)));
      }
    }
  }
  return table;
}

file::Json outage_json(const OutageScore& score) {
  return {{"seconds", score.seconds},
          {"outages", score.errors.size()},
          {"median", file::number(error_quantile(score, 0.5))},
          {"p95", file::number(error_quantile(score, 0.95))},
          {"inside_90", file::number(inside_share(score))},
          {"errors", file::numbers(score.errors)}};
}

file::Json result_json(const ReckoningResult& result) {
  return {{"source", result.source},
          {"simulated", result.simulated},
          {"split", result.split},
          {"held_out_rows", result.held_out},
          {"yaw_rate_measured", result.yaw_rate},
          {"navigators", file::list(result.scores, [](const NavigatorScore& navigator) {
             return file::Json{{"name", navigator.name},
                               {"outages", file::list(navigator.outages, outage_json)}};
           })}};
}

}  // namespace

std::string reckoning_table(const std::vector<ReckoningResult>& results) {
  std::vector<chart::TextTable> tables;
  std::ranges::transform(results, std::back_inserter(tables), result_table);
  return chart::tables_text(tables);
}

std::string reckoning_json(const std::vector<ReckoningResult>& results) {
  const file::Json document = {
      {"format", "kelpie-reckoning"}, {"version", 1}, {"logs", file::list(results, result_json)}};
  return file::json_text(document, 1);
}

}  // namespace kelpie::lab
