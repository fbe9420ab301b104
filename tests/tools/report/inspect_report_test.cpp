// SPDX-License-Identifier: Apache-2.0
#include "report/inspect_report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace kelpie::inspect_report_test {
namespace {

bag::BagReport two_topics() {
  bag::TopicReport odom{.name = "/odom", .type = "nav_msgs/msg/Odometry", .messages = 9};
  odom.clock_offset = bag::ClockOffset{5.0, 4.0, 6.5};
  odom.fields = {{"twist.linear.x", -1.0, 2.25, 9, 0}, {"pose.x", 0.0, 0.0, 0, 7}};
  bag::TopicReport other{.name = "/" + std::string(60, 'x'), .type = "x_msgs/msg/X"};
  other.not_decoded = "x_msgs/X: its definition is missing";
  bag::BagReport report;
  report.messages = 9;
  report.duration_s = 9.5;
  report.topics = {odom, other};
  return report;
}

TEST(InspectReport, TheTableNamesTopicsWholeWithTheirRangesAndWhyThereAreNone) {
  const std::string table = report::inspect_table(two_topics(), "small.mcap");
  for (const std::string& words :
       {std::string("small.mcap: 9 messages, 2 topics"), std::string(60, 'x'),
        std::string("5.0000    2.5000  nav_msgs/msg/Odometry\n"), std::string("2.25"),
        std::string("7 not finite"),
        std::string("not decoded: x_msgs/X: its definition is missing")}) {
    EXPECT_NE(table.find(words), std::string::npos) << words << "\n" << table;
  }
}

TEST(InspectReport, TheJsonHoldsTheSameNumbers) {
  const auto json =
      nlohmann::json::parse(report::inspect_json(two_topics(), {}, std::nullopt, {}, "small.mcap"));
  EXPECT_EQ(json.at("messages"), 9);
  const auto& odom = json.at("topics").at(0);
  EXPECT_EQ(odom.at("name"), "/odom");
  EXPECT_EQ(odom.at("clock_offset_s").at("median"), 5.0);
  EXPECT_EQ(odom.at("fields").at(0).at("high"), 2.25);
  EXPECT_TRUE(odom.at("fields").at(1).at("high").is_null());
  EXPECT_TRUE(json.at("topics").at(1).at("clock_offset_s").is_null());
}

TEST(InspectReport, SaysWhatIsOpenAndWhetherCommandsExplainAnything) {
  log::Draft draft;
  draft.taken = {"u = /odom:twist.twist.linear.x"};
  draft.remarks = {"commands come at 2 Hz"};
  study::FirstLook look{.rows = 100, .held_out = 20, .rate_hz = 10.0, .alignment = {}, .axes = {}};
  look.axes = {{"udot", 0.6, 0.1}};
  const auto says = [&](const std::string& words) {
    const std::string table = report::draft_table(draft, look);
    return table.find(words) != std::string::npos;
  };
  EXPECT_TRUE(says("u = /odom:twist.twist.linear.x"));
  EXPECT_TRUE(says("commands come at 2 Hz"));
  EXPECT_TRUE(says("belong together"));
  look.axes = {{"udot", 0.61, 0.6}};
  EXPECT_TRUE(says("nothing shows that these commands move"));
  look.axes = {{"udot", -0.5, -0.9}};  // both worse than the mean
  EXPECT_TRUE(says("nothing shows that these commands move"));
  draft.open = {"commands: /a, or /b: which of them?"};
  EXPECT_TRUE(says("open: commands: /a, or /b"));
  const auto json =
      nlohmann::json::parse(report::inspect_json(two_topics(), draft, look, {}, "small.mcap"));
  EXPECT_EQ(json.at("draft").at("complete"), false);
  EXPECT_EQ(json.at("first_look").at("axes").at(0).at("r2"), -0.5);
}

TEST(InspectReport, NamesCannotSteerATerminal) {
  bag::BagReport report = two_topics();
  report.topics[0].name = "/\x1b[31m\x80";
  report.topics[0].type = "a\nb";
  const std::string table = report::inspect_table(report, "small.mcap");
  EXPECT_EQ(table.find('\x1b'), std::string::npos);
  EXPECT_EQ(table.find("a\nb"), std::string::npos);
}

TEST(InspectReport, AnEmptyBagHasNoTimes) {
  EXPECT_EQ(report::inspect_table({}, "x").find("from"), std::string::npos);
}

}  // namespace
}  // namespace kelpie::inspect_report_test
