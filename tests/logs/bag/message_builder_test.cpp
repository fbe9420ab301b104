// SPDX-License-Identifier: Apache-2.0
#include "bag/message_builder.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>

#include "bag/bags.hpp"
#include "bag/cdr.hpp"
#include "bag/open_bag.hpp"
#include "bag/series.hpp"
#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::message_builder_test {
namespace {

using testing::Bytes;
using testing::CdrMessage;

bag::MessageType type_of(const std::string& name, const std::string& text = {}) {
  return bag::MessageDefinitions().type(name, text);
}

Bytes bytes_of(bag::MessageBuilder& builder) {
  const auto bytes = builder.bytes();
  return {bytes.begin(), bytes.end()};
}

// Every number of a message in the order of storage, read by the reader of bags.
class Numbers : public bag::NumberVisitor {
 public:
  bool wants(std::size_t /*field*/) const override { return true; }
  void number(std::size_t /*field*/, std::span<const std::uint32_t> /*index*/,
              double value) override {
    values.push_back(value);
  }
  std::vector<double> values;
};

std::vector<double> read_back(const bag::MessageType& type, bag::MessageBuilder& builder) {
  Numbers numbers;
  bag::visit_numbers(type, builder.bytes(), numbers);
  return numbers.values;
}

// Padding is left as it comes: its bytes mean nothing.
Bytes without_padding(Bytes bytes) {
  std::ranges::replace(bytes, std::byte{0xEE}, std::byte{0});
  return bytes;
}

TEST(MessageBuilder, WritesTheBytesOfTheStandard) {
  bag::MessageBuilder twist(type_of("geometry_msgs/msg/TwistStamped"));
  twist.set("header.stamp.sec", 7.0);
  twist.set("header.frame_id", "base_link");
  twist.set("twist.linear.x", 0.25);
  EXPECT_EQ(bytes_of(twist), without_padding(testing::twist_stamped(7, 0.25)));

  bag::MessageBuilder array(type_of("std_msgs/msg/Float64MultiArray"));
  array.set("layout.dim[0].label", "thrusters");
  array.set("layout.dim[0].size", 2.0);
  array.set("layout.dim[0].stride", 2.0);
  array.set("data", std::vector<double>{0.5, -0.5});
  CdrMessage expected;
  expected.add(std::uint32_t{1}).text("thrusters").add(std::uint32_t{2}).add(std::uint32_t{2});
  expected.add(std::uint32_t{0}).add(std::uint32_t{2}).add(0.5).add(-0.5);
  EXPECT_EQ(bytes_of(array), without_padding(expected.bytes()));
}

TEST(MessageBuilder, EveryKindOfNumberAtItsLimitsIsReadBack) {
  const std::string text =
      "bool a\nint8 b\nuint8 c\nint16 d\nuint16 e\nint32 f\nuint32 g\nint64 h\nuint64 i\nfloat32 "
      "j\nfloat64 k\n";
  const bag::MessageType type = type_of("test_msgs/msg/Test", text);
  bag::MessageBuilder builder(type);
  const std::vector<std::pair<const char*, double>> values{{"a", 1},
                                                           {"b", -128},
                                                           {"c", 255},
                                                           {"d", -32768},
                                                           {"e", 65535},
                                                           {"f", -2147483648.0},
                                                           {"g", 4294967295.0},
                                                           {"h", -9007199254740992.0},
                                                           {"i", 9007199254740992.0},
                                                           {"j", 0.125},
                                                           {"k", 1e-300}};
  std::vector<double> expected;
  for (const auto& [path, value] : values) {
    builder.set(path, value);
    expected.push_back(value);
  }
  EXPECT_EQ(read_back(type, builder), expected);
}

TEST(MessageBuilder, DiagnosticsOfSeveralPartsAreReadBack) {
  const bag::MessageType type = type_of("diagnostic_msgs/msg/DiagnosticArray");
  bag::MessageBuilder builder(type);
  builder.set("header.stamp.sec", 12.0);
  builder.set("status[1].level", 2.0);
  builder.set("status[1].name", "kelpie: learning");
  builder.set("status[1].values[2].key", "lag");
  builder.set("status[0].level", 1.0);
  EXPECT_EQ(read_back(type, builder), (std::vector<double>{12, 0, 1, 2}));
  builder.resize("status", 1);
  EXPECT_EQ(read_back(type, builder), (std::vector<double>{12, 0, 1}));
}

TEST(MessageBuilder, WhatIsNoFieldOrNoValueOfItIsNamed) {
  bag::MessageBuilder builder(type_of("diagnostic_msgs/msg/DiagnosticArray"));
  const std::vector<double> three(3);
  for (const char* const path :
       {"", "headr", "header.stamp.secs", "status.level", "status[x].level", "status[0",
        "header[0].stamp.sec", "status[0].name"}) {
    EXPECT_THROW(builder.set(path, 1.0), InputError) << path;
  }
  EXPECT_THROW(builder.set("status[0].level", 256.0), InputError);
  EXPECT_THROW(builder.set("status[0].level", 0.5), InputError);
  EXPECT_THROW(builder.set("status[0].level", std::numeric_limits<double>::quiet_NaN()),
               InputError);
  EXPECT_THROW(builder.set("status[0].level", "high"), InputError);
  EXPECT_THROW(builder.set("header.stamp.sec", three), InputError);
  bag::MessageBuilder accel(type_of("geometry_msgs/msg/AccelWithCovarianceStamped"));
  EXPECT_THROW(accel.set("accel.covariance", three), InputError);
  EXPECT_THROW(accel.set("accel.covariance[36]", 1.0), InputError);
  EXPECT_THROW(accel.set("accel.covariance", 1.0), InputError);
  EXPECT_THROW(accel.resize("accel.covariance", 35), InputError);
}

RC_GTEST_PROP(MessageBuilder, AnyNumbersInAnySequencesAreReadBack,
              (const std::vector<std::vector<double>>& lists, const std::string& label)) {
  const bag::MessageType type =
      type_of("test_msgs/msg/Test",
              "uint8 before\nList[] lists\nfloat64 last\n====\nMSG: test_msgs/List\n"
              "string label\nfloat64[] values\nuint8 end\n");
  bag::MessageBuilder builder(type);
  std::vector<double> expected{3};
  builder.set("before", 3.0);
  for (std::size_t i = 0; i < lists.size(); ++i) {
    const std::string path = "lists[" + std::to_string(i) + "].";
    builder.set(path + "label", label);
    builder.set(path + "values", lists[i]);
    builder.set(path + "end", 9.0);
    expected.insert(expected.end(), lists[i].begin(), lists[i].end());
    expected.push_back(9);
  }
  builder.set("last", -1.5);
  expected.push_back(-1.5);
  RC_ASSERT(read_back(type, builder) == expected);
}

// A .db3 file of Humble has no definitions.
TEST(MessageBuilder, ABagOfAVehicleWithMavrosIsReadWithoutDefinitions) {
  const std::vector<bag::Topic> topics{{.name = "/mavros/rc/out", .type = "mavros_msgs/msg/RCOut"},
                                       {.name = "/dvl", .type = "dvl_msgs/msg/DVL"},
                                       {.name = "/tf", .type = "tf2_msgs/msg/TFMessage"}};
  bag::MessageBuilder pulses(type_of(topics[0].type));
  pulses.set("channels", std::vector<double>{1500, 1612, 1388});
  bag::MessageBuilder dvl(type_of(topics[1].type));
  dvl.resize("beams", 4);
  dvl.set("velocity.x", 0.4);
  dvl.set("form", "json_v3.1");
  bag::MessageBuilder transforms(type_of(topics[2].type));
  transforms.resize("transforms", 1);
  transforms.set("transforms[0].child_frame_id", "base_link");
  transforms.set("transforms[0].transform.rotation.w", 0.5);
  const testing::TemporaryFolder folder;
  testing::write_db3(folder / "x.db3", topics,
                     {{0, testing::kSecond, bytes_of(pulses)},
                      {1, testing::kSecond, bytes_of(dvl)},
                      {2, testing::kSecond, bytes_of(transforms)}});
  const std::vector<std::string> columns{"/mavros/rc/out:channels[1]", "/dvl:velocity.x",
                                         "/tf:transforms[0].transform.rotation.w"};
  const auto bag = bag::open_bag(folder / "x.db3");
  const std::vector<bag::Series> all =
      bag::read_series(*bag, bag::MessageDefinitions(), columns, bag::Clock::receive);
  EXPECT_EQ(all[0].values[0], std::vector<double>{1612});
  EXPECT_EQ(all[1].values[0], std::vector<double>{0.4});
  EXPECT_EQ(all[2].values[0], std::vector<double>{0.5});
}

}  // namespace
}  // namespace kelpie::message_builder_test
