// SPDX-License-Identifier: Apache-2.0
#include "report/yardstick_table.hpp"

#include <string>

#include "chart/wording.hpp"

namespace kelpie::report {
namespace {

constexpr std::string_view kDisturbanceNote =
    "With disturbance: kelpie's prediction and what it missed of late (docs/disturbance.md). ";

}  // namespace

chart::TextTable yardstick_table(const study::StreamResult& result) {
  chart::TextTable table{
      "Beside simple predictors (R²)",
      {"axis", "held out:\nkelpie", "\nleast squares", "\nmean", "one ahead:\nkelpie",
       "\nwith disturbance", "\nleast squares", "\nlast value"},
      {},
      {std::string(kDisturbanceNote) + std::string(kYardstickNote)}};
  for (const study::AxisResult& axis : result.axes) {
    const study::Yardsticks& beside = axis.yardsticks;
    table.rows.push_back(
        {chart::shortened(axis.name, chart::kLongestName), chart::decimal(axis.r2_final),
         chart::decimal(beside.least_squares.r2_final), chart::decimal(beside.mean.r2_final),
         chart::decimal(axis.prequential_r2), chart::decimal(axis.corrected_r2),
         chart::decimal(beside.least_squares.prequential_r2),
         chart::decimal(beside.last_value.prequential_r2)});
  }
  return table;
}

}  // namespace kelpie::report
