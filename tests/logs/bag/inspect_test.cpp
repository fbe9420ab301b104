// SPDX-License-Identifier: Apache-2.0
#include "bag/inspect.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "bag/bags.hpp"
#include "support.hpp"

namespace kelpie::inspect_test {
namespace {

using testing::float_array;
using testing::kSecond;
using testing::Recorded;

bag::BagReport report_of(const std::vector<bag::Topic>& topics,
                         const std::vector<Recorded>& messages,
                         bag::ReadMode mode = bag::ReadMode::strict) {
  const std::string file = testing::mcap_of(topics, messages);
  const auto bag = bag::read_mcap(testing::as_bytes(file), "small.mcap", mode);
  return bag::inspect_bag(*bag, bag::MessageDefinitions());
}

const bag::FieldRange& field(const bag::TopicReport& topic, const std::string& path) {
  const auto found = std::ranges::find(topic.fields, path, &bag::FieldRange::path);
  if (found == topic.fields.end()) {
    throw std::out_of_range(path);
  }
  return *found;
}

TEST(Inspect, CountsRatesGapsClocksAndRanges) {
  std::vector<Recorded> messages = testing::small_messages(10);
  messages.erase(messages.begin() + 8);  // the message of /odom at 14 s
  const bag::BagReport report = report_of(testing::small_topics(), messages);
  EXPECT_EQ(report.messages, 19U);
  EXPECT_EQ(report.start_ns, 10 * kSecond);
  EXPECT_DOUBLE_EQ(report.duration_s, 9.5);
  const bag::TopicReport& odom = report.topics.at(0);
  EXPECT_EQ(odom.messages, 9U);
  EXPECT_DOUBLE_EQ(odom.rate_hz, 8.0 / 9.0);
  EXPECT_DOUBLE_EQ(odom.longest_gap_s, 2.0);
  EXPECT_DOUBLE_EQ(odom.longest_gap_at_s, 3.0);
  EXPECT_DOUBLE_EQ(odom.clock_offset.value().median_s, 5.0);
  EXPECT_DOUBLE_EQ(field(odom, "twist.linear.x").high, 2.25);
  const bag::TopicReport& thrusters = report.topics.at(1);
  EXPECT_FALSE(thrusters.clock_offset.has_value());
  EXPECT_DOUBLE_EQ(field(thrusters, "data[]").low, -18.0);
  EXPECT_EQ(field(thrusters, "data[]").finite, 20U);
}

TEST(Inspect, ATopicThatNobodyDefinesIsCountedAndSaysWhy) {
  const bag::BagReport report = report_of(
      {{.name = "/x", .type = "x_msgs/msg/X"}, {.name = "/y", .type = "", .encoding = "json"}},
      {{0, kSecond, float_array({1})}, {1, kSecond, float_array({1})}});
  EXPECT_EQ(report.topics.at(0).messages, 1U);
  EXPECT_NE(report.topics.at(0).not_decoded.find("--msg-dir"), std::string::npos);
  EXPECT_NE(report.topics.at(1).not_decoded.find("'json'"), std::string::npos);
}

// Found by fuzzing: the text of an error ended at the NUL, so there seemed to be none.
TEST(Inspect, ATopicWhoseTypeBeginsWithANulIsNotDecodedAndSaysWhy) {
  const bag::BagReport report =
      report_of({{.name = "/x", .type = std::string("\0x_msgs/msg/X", 13)}},
                {{0, kSecond, float_array({1})}});
  EXPECT_EQ(report.topics.at(0).messages, 1U);
  EXPECT_TRUE(report.topics.at(0).not_decoded.starts_with("?x_msgs"))
      << report.topics.at(0).not_decoded;
}

TEST(Inspect, ElementsOfBulkBytesAreNoNumbersAndNaNIsCounted) {
  testing::CdrMessage message;
  message.add(std::uint32_t{2}).add(std::uint8_t{1}).add(std::uint8_t{2});
  message.add(std::numeric_limits<double>::quiet_NaN());
  const bag::BagReport report =
      report_of({{.name = "/i", .type = "i/msg/I", .definition = "uint8[] image\nfloat64 x\n"}},
                {{0, kSecond, message.bytes()}});
  ASSERT_EQ(report.topics.at(0).fields.size(), 1U);
  EXPECT_EQ(report.topics.at(0).fields.at(0).not_finite, 1U);
}

TEST(Inspect, AnEmptyBagHasNoTimes) {
  const bag::BagReport report = report_of({}, {});
  EXPECT_EQ(report.messages, 0U);
}

}  // namespace
}  // namespace kelpie::inspect_test
