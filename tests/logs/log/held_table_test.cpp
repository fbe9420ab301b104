// SPDX-License-Identifier: Apache-2.0
#include "log/held_table.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bag/bags.hpp"
#include "support.hpp"

namespace kelpie::held_table_test {
namespace {

using testing::small_messages;
using testing::small_topics;

using Names = std::vector<std::string>;

std::vector<bag::Series> series_of(const Names& columns) {
  const std::string file = testing::mcap_of(small_topics(), small_messages(3));
  const auto bag = bag::read_mcap(testing::as_bytes(file), "small.mcap", bag::ReadMode::strict);
  return bag::read_series(*bag, bag::MessageDefinitions(), columns, bag::Clock::receive);
}

TEST(HeldTable, OtherTopicsHoldTheirLastValue) {
  const auto series = series_of({"/thrusters:data[0]", "/odom:twist.linear.x"});
  const log::Table table =
      log::held_table(series, Names{"/thrusters:data[0]", "/odom:twist.linear.x"}, "b");
  EXPECT_EQ(table.names, (Names{"t", "/thrusters:data[0]", "/odom:twist.linear.x"}));
  EXPECT_EQ(table.columns[0], (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(table.columns[2], (std::vector<double>{0.0, 0.25, 0.5}));
  const auto turned = series_of({"/odom:twist.linear.x", "/thrusters:data[0]"});
  const log::Table other = log::held_table(turned, Names{"/thrusters:data[0]"}, "b");
  EXPECT_TRUE(std::isnan(other.columns[1][0]));  // none came before the first row
  EXPECT_EQ(other.columns[1][1], 0.0);
  EXPECT_EQ(other.columns[1][2], 1.0);
}

}  // namespace
}  // namespace kelpie::held_table_test
