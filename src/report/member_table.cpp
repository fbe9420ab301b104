// SPDX-License-Identifier: Apache-2.0
#include "report/member_table.hpp"

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "chart/wording.hpp"

namespace kelpie::report {
namespace {

constexpr std::string_view kMemberNote =
    "By how well each foretold what lay ahead, lately. Learner: the paper's, with the settings. "
    "Precise: the same for logs without noise. Memory: least squares on all samples, with a "
    "kernel. Line: the same without one. Mean: of the targets (docs/committee.md).";

}  // namespace

chart::TextTable member_table(const study::StreamResult& result) {
  chart::TextTable table{"Who is believed", {"axis"}, {}, {std::string(kMemberNote)}};
  for (const study::AxisResult& axis : result.axes) {
    if (axis.members.empty()) {
      continue;
    }
    std::vector<std::string> row{chart::shortened(axis.name, chart::kLongestName)};
    for (const MemberShare& member : axis.members) {
      if (table.rows.empty()) {
        table.head.push_back(member.name);
      }
      row.push_back(fmt::format("{:.0f} %", 100.0 * member.share));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace kelpie::report
