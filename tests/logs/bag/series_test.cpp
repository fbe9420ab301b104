// SPDX-License-Identifier: Apache-2.0
#include "bag/series.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bag/bags.hpp"
#include "support.hpp"

namespace kelpie::series_test {
namespace {

using testing::float_array;
using testing::kSecond;
using testing::Recorded;
using testing::small_messages;
using testing::small_topics;
using testing::twist_stamped;

using Names = std::vector<std::string>;

std::vector<bag::Series> series_of(const std::vector<Recorded>& messages, const Names& columns,
                                   bag::Clock clock = bag::Clock::receive,
                                   bag::ReadMode mode = bag::ReadMode::strict) {
  const std::string file = testing::mcap_of(small_topics(), messages);
  const auto bag = bag::read_mcap(testing::as_bytes(file), "small.mcap", mode);
  return bag::read_series(*bag, bag::MessageDefinitions(), columns, clock);
}

std::string refusal(const Names& columns, bag::Clock clock = bag::Clock::receive) {
  return testing::message_of<InputError>([&] { series_of(small_messages(4), columns, clock); });
}

const Names kColumns{"/odom:twist.linear.x", "/thrusters:data[1]", "/odom:header.stamp.sec"};

TEST(Series, OnePerTopicWithItsColumns) {
  const auto series = series_of(small_messages(4), kColumns);
  ASSERT_EQ(series.size(), 2U);
  EXPECT_EQ(series[0].topic, "/odom");
  EXPECT_EQ(series[0].names, (Names{kColumns[0], kColumns[2]}));
  EXPECT_EQ(series[0].values[0], (std::vector<double>{0.0, 0.25, 0.5, 0.75}));
  EXPECT_EQ(series[0].values[1], (std::vector<double>{5, 6, 7, 8}));
  EXPECT_EQ(series[1].values[0], (std::vector<double>{0, -2, -4, -6}));
  EXPECT_EQ(series[1].times_ns[0], 10 * kSecond + kSecond / 2);
}

TEST(Series, MessagesStoredOutOfOrderAreSorted) {
  std::vector<Recorded> messages = small_messages(4);
  std::ranges::reverse(messages);
  const auto series = series_of(messages, kColumns);
  EXPECT_EQ(series[0].values[0], (std::vector<double>{0.0, 0.25, 0.5, 0.75}));
  EXPECT_TRUE(std::ranges::is_sorted(series[0].times_ns));
  EXPECT_EQ(series[0].steps_back, 3U);
  EXPECT_EQ(series[0].longest_back_ns, kSecond);
  EXPECT_EQ(series_of(small_messages(4), kColumns)[0].steps_back, 0U);
}

TEST(Series, TheHeadersClockIsTheSenders) {
  const auto series = series_of(small_messages(3), {kColumns[0]}, bag::Clock::header);
  EXPECT_EQ(series[0].times_ns, (std::vector<std::int64_t>{5 * kSecond, 6 * kSecond, 7 * kSecond}));
  EXPECT_NE(refusal(kColumns, bag::Clock::header)
                .find("/thrusters: std_msgs/msg/Float64MultiArray has no header"),
            std::string::npos);
}

TEST(Series, AnElementThatAMessageLacksIsNaN) {
  const std::vector<Recorded> messages{{1, kSecond, float_array({1, 2})},
                                       {1, 2 * kSecond, float_array({3})},
                                       {1, 3 * kSecond, float_array({4, 5})}};
  const auto series = series_of(messages, {"/thrusters:data[1]"});
  EXPECT_EQ(series[0].values[0][0], 2.0);
  EXPECT_TRUE(std::isnan(series[0].values[0][1]));
  EXPECT_EQ(series[0].values[0][2], 5.0);
}

TEST(Series, NamesThatAreWrongMeetTheNearestThatIsRight) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"/odm:twist.linear.x", "small.mcap: /odm: there is no such topic (did you mean '/odom'?)"},
      {"/odom:twist.linear.z2", "no field twist.linear.z2 (did you mean 'twist.linear.z'?)"},
      {"/odom:header.frame_id", "is text"},
      {"/odom:twist", "has no field twist"},
      {"/thrusters:data", "is an array; name one of its elements, as in /thrusters:data[0]"},
      {"/thrusters:data[2]", "no message has that element"},
      {"/thrusters:data[x]", "a whole number"},
      {"/thrusters:data[1", "a whole number"},
      {"/thrusters", "is no column of a bag"},
      {":x", "is no column of a bag"},
      {"/odom:", "is no column of a bag"},
  };
  for (const auto& [column, message] : cases) {
    EXPECT_NE(refusal({column}).find(message), std::string::npos)
        << column << ": " << refusal({column});
  }
}

TEST(Series, AnIndexBeyondAFixedArrayIsRefusedWhateverTheMessages) {
  const std::vector<bag::Topic> topics{
      {.name = "/a", .type = "a/msg/A", .definition = "int8[3] v\n"}};
  const std::string file = testing::mcap_of(topics, {});
  const auto read = [&](const Names& columns) {
    const auto bag = bag::read_mcap(testing::as_bytes(file), "a.mcap", bag::ReadMode::strict);
    bag::read_series(*bag, bag::MessageDefinitions(), columns, bag::Clock::receive);
  };
  EXPECT_NE(testing::message_of<InputError>([&] { read({"/a:v[3]"}); }).find("v has 3 elements"),
            std::string::npos);
  EXPECT_EQ(testing::message_of<InputError>([&] { read({"/a:v[2]"}); }),
            "a.mcap: /a: has no readable messages");
}

TEST(Series, AMessageTooShortIsNamedByFileTopicAndOffsetOrLeftOut) {
  std::vector<Recorded> messages = small_messages(4);
  messages[2].data.resize(20);
  const std::string refused =
      testing::message_of<InputError>([&] { series_of(messages, kColumns); });
  EXPECT_TRUE(refused.starts_with("small.mcap: /odom, chunk at offset 35, offset 351: byte 16"))
      << refused;
  EXPECT_NE(refused.find("frame_id: the message is too short"), std::string::npos) << refused;
  const auto series = series_of(messages, kColumns, bag::Clock::receive, bag::ReadMode::recover);
  EXPECT_EQ(series[0].values[0], (std::vector<double>{0.0, 0.5, 0.75}));
}

}  // namespace
}  // namespace kelpie::series_test
