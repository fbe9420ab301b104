// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "chart/wording.hpp"
#include "cli/command.hpp"

namespace kelpie::hostile_command_test {
namespace {

using testing::Outcome;

class HostileCommand : public testing::CommandTest {};

// The table's line of a kind: a name, then numbers.
std::vector<std::string> cells_of(const std::string& table, const std::string& kind) {
  std::istringstream text(table.substr(table.find("\n  " + kind + " ")));
  std::vector<std::string> cells;
  for (std::string cell; cells.size() < 10 && text >> cell;) {
    cells.push_back(cell);
  }
  return cells;
}

TEST_F(HostileCommand, TableAndNumbersAgreeWithAnyNumberOfThreads) {
  const std::string command =
      "hostile --kinds clean,one_burst --seeds 1 --set buffer=100 --set adapt=none ";
  const Outcome outcome = testing::succeeded(run(command + "--threads 2 --json two.json"));
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(testing::succeeded(run(command + "--threads 1 --json one.json")).out, outcome.out);
  EXPECT_EQ(content("one.json"), content("two.json"));
  const auto json = parsed("one.json");
  ASSERT_EQ(json["kinds"].size(), 2U);
  for (const auto& kind : json["kinds"]) {
    const auto cells = cells_of(outcome.out, kind["name"]);
    ASSERT_EQ(cells.size(), 10U) << outcome.out;
    const auto& r2 = kind["late_r2"];
    EXPECT_EQ(cells[1], chart::decimal(r2["kelpie"])) << outcome.out;
    EXPECT_EQ(cells[2], chart::decimal(r2["least_squares"])) << outcome.out;
    EXPECT_EQ(cells[3], chart::decimal(r2["forgetting"])) << outcome.out;
    EXPECT_EQ(cells[4], chart::decimal(r2["mean"])) << outcome.out;
    EXPECT_EQ(cells[6], chart::decimal(kind["worst_axis"])) << outcome.out;
    EXPECT_EQ(kind["axes"].size(), 3U);
  }
  const auto total = [&](const char* name) { return std::to_string(json["all"][name].get<int>()); };
  EXPECT_NE(outcome.out.find(total("kinds_behind") + " of 2 kinds"), std::string::npos);
  EXPECT_NE(outcome.out.find(total("axes_too_low") + " of 6 axes"), std::string::npos);
  const auto& clean = json["kinds"][0];
  EXPECT_GT(clean["late_r2"]["kelpie"], 0.5);
  EXPECT_GT(clean["late_r2"]["least_squares"], 0.9);
  EXPECT_NEAR(clean["late_r2"]["mean"], 0.0, 0.1);
  EXPECT_EQ(clean["beyond"], 0);
  EXPECT_EQ(clean["not_finite"], 0);
}

TEST_F(HostileCommand, RefusesBadInput) {
  testing::expect_refused(run("hostile --kinds cleam"),
                          "--kinds: 'cleam' is no kind (did you mean 'clean'?)");
  testing::expect_refused(run("hostile --seeds 0"), "--seeds");
  testing::expect_refused(run("hostile --kinds clean --set bufer=1"), "bufer");
}

}  // namespace
}  // namespace kelpie::hostile_command_test
