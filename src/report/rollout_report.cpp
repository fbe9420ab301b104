// SPDX-License-Identifier: Apache-2.0
#include "report/rollout_report.hpp"

#include "chart/wording.hpp"

namespace kelpie::report {
std::string rollout_table(const study::OpenLoopResult& result) {
  std::string text = chart::wrapped(rollout_method(result)) + "\n\n";
  std::vector<chart::TextTable> tables = rollout_tables(result);
  for (chart::TextTable& table : tables) {
    table.whole = true;  // a cell holds a number for each state
    text += chart::table_text(table);
  }
  return text;
}

}  // namespace kelpie::report
