// SPDX-License-Identifier: Apache-2.0
#include "bag/cdr.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <map>

#include "bag/bags.hpp"
#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::cdr_test {
namespace {

using testing::Bytes;
using testing::CdrMessage;
using testing::message_of;

// All numbers of a message by their paths, indices filled in.
class Collector : public bag::NumberVisitor {
 public:
  explicit Collector(const bag::MessageType& type) : type_(type) {}

  bool wants(std::size_t leaf) const override { return type_.leaves[leaf].path != unwanted; }
  void number(std::size_t leaf, std::span<const std::uint32_t> indices, double value) override {
    std::string path = type_.leaves[leaf].path;
    std::size_t at = 0;
    for (const std::uint32_t index : indices) {
      at = path.find("[]", at);
      const std::string number = std::to_string(index);
      path.insert(at + 1, number);
      at += number.size() + 2;
    }
    values[path] = value;
  }

  std::string unwanted;
  std::map<std::string, double> values;

 private:
  const bag::MessageType& type_;
};

bag::MessageType type_of(const std::string& text) {
  return bag::MessageDefinitions().type("test_msgs/msg/Test", text);
}

std::map<std::string, double> decoded(const std::string& definition, const Bytes& message) {
  const bag::MessageType type = type_of(definition);
  Collector collector(type);
  bag::visit_numbers(type, message, collector);
  return collector.values;
}

std::string refusal(const std::string& definition, const Bytes& message) {
  return testing::message_of<InputError>([&] { decoded(definition, message); });
}

using Values = std::map<std::string, double>;

class Cdr : public ::testing::TestWithParam<std::endian> {};

TEST_P(Cdr, EveryKindOfNumberInEitherByteOrder) {
  CdrMessage message(GetParam());
  message.add(std::uint8_t{1}).add(std::int8_t{-2}).add(std::int16_t{-300}).add(std::uint8_t{200});
  message.add(std::uint16_t{60000}).add(std::int32_t{-70000}).add(std::uint32_t{4000000000U});
  message.add(std::int64_t{-5000000000}).add(std::uint8_t{9}).add(std::uint64_t{1} << 63U);
  message.add(0.5F).add(-1e300);
  EXPECT_EQ(decoded("bool a\nint8 b\nint16 c\nbyte d\nuint16 e\nint32 f\nuint32 g\nint64 h\n"
                    "char i\nuint64 j\nfloat32 k\nfloat64 l\n",
                    message.bytes()),
            (Values{{"a", 1},
                    {"b", -2},
                    {"c", -300},
                    {"d", 200},
                    {"e", 60000},
                    {"f", -70000},
                    {"g", 4e9},
                    {"h", -5e9},
                    {"i", 9},
                    {"j", 9223372036854775808.0},
                    {"k", 0.5},
                    {"l", -1e300}}));
}

TEST_P(Cdr, SequencesArraysTextAndStructuresWithinThem) {
  CdrMessage message(GetParam());
  message.text("abc").add(std::uint32_t{2});  // name, two pairs
  message.add(std::uint8_t{7}).add(0.25).add(std::uint8_t{8}).add(0.5);
  message.add(std::int16_t{1}).add(std::int16_t{2}).add(std::int16_t{3});
  message.add(std::uint32_t{0});  // no floats: nothing is aligned for them
  message.add(std::uint32_t{1}).text("x").add(std::uint8_t{5});
  EXPECT_EQ(decoded("string name\nPair[] pairs\nint16[3] three\nfloat64[<=4] none\n"
                    "string<=3[<=2] words\nuint8 last\n=====\nMSG: test_msgs/Pair\n"
                    "uint8 a\nfloat64 b\n",
                    message.bytes()),
            (Values{{"pairs[0].a", 7},
                    {"pairs[0].b", 0.25},
                    {"pairs[1].a", 8},
                    {"pairs[1].b", 0.5},
                    {"three[0]", 1},
                    {"three[1]", 2},
                    {"three[2]", 3},
                    {"last", 5}}));
}

INSTANTIATE_TEST_SUITE_P(Both, Cdr, ::testing::Values(std::endian::little, std::endian::big));

TEST(Cdr, AStructureWithoutMembersIsOneByte) {
  CdrMessage message;
  message.add(std::uint8_t{0}).add(std::uint8_t{42});
  EXPECT_EQ(decoded("Nothing nothing\nuint8 x\n====\nMSG: test_msgs/Nothing\nint8 A=1\n====\n",
                    message.bytes()),
            (Values{{"x", 42}}));
}

TEST(Cdr, WhatNobodyWantsIsPassedOverWithItsAlignment) {
  CdrMessage message;
  message.add(std::uint8_t{1}).add(std::uint32_t{3}).add(1.0).add(2.0).add(3.0);
  message.add(std::uint8_t{4}).add(5.0);
  const bag::MessageType type = type_of("uint8 a\nfloat64[] many\nuint8 b\nfloat64 c\n");
  Collector collector(type);
  collector.unwanted = "many[]";
  bag::visit_numbers(type, message.bytes(), collector);
  EXPECT_EQ(collector.values, (Values{{"a", 1}, {"b", 4}, {"c", 5}}));
}

TEST(Cdr, LengthsAreCheckedBeforeAnythingIsDoneWithThem) {
  CdrMessage huge;
  huge.add(std::numeric_limits<std::uint32_t>::max()).add(1.0);
  EXPECT_EQ(refusal("float64[] v\n", huge.bytes()),
            "byte 8, v: the message is too short: 34359738360 bytes are due at least, 12 are left");
  EXPECT_NE(refusal("string v\n", huge.bytes()).find("too short"), std::string::npos);
  EXPECT_NE(refusal("string[] v\n", huge.bytes()).find("too short"), std::string::npos);
  CdrMessage five;
  five.add(std::uint32_t{5}).add(std::uint32_t{0}).add(std::uint32_t{0});
  EXPECT_EQ(refusal("uint8[<=4] v\n", five.bytes()),
            "byte 8, v: has 5 elements; its type allows 4");
  EXPECT_EQ(refusal("string<=3 v\n", five.bytes()), "byte 8, v: has 4 bytes; its type allows 3");
}

TEST(Cdr, AWrongDefinitionOrEncodingIsNamed) {
  CdrMessage message;
  message.add(1.0).add(2.0);
  EXPECT_NE(refusal("float64 a\n", message.bytes()).find("8 bytes are left over"),
            std::string::npos);
  EXPECT_NE(refusal("float64 a\nfloat64 b\nfloat64 c\n", message.bytes())
                .find("byte 20, c: the message is too short"),
            std::string::npos);
  Bytes other = message.bytes();
  other[1] = std::byte{7};
  EXPECT_NE(refusal("float64 a\n", other).find("has the number 7"), std::string::npos);
  EXPECT_NE(refusal("float64 a\n", Bytes(3)).find("too short"), std::string::npos);
}

// A message in which some bytes are others. Without any it is read; with some it is read as well,
// or refused at a byte that it has.
RC_GTEST_PROP(Cdr, DamageIsRefusedOrRead, ()) {
  const bag::MessageType type = type_of(
      "Part[] parts\nstring<=7[] words\nbool[5] flags\n====\nMSG: test_msgs/Part\nstring s\n"
      "float32[<=6] v\nint64 i\n");
  CdrMessage message;
  message.add(std::uint32_t{2});  // parts
  for (const float value : {1.5F, -2.5F}) {
    message.text("abc").add(std::uint32_t{1}).add(value).add(std::int64_t{7});
  }
  message.add(std::uint32_t{1}).text("x");
  for (int flag = 0; flag < 5; ++flag) {
    message.add(std::uint8_t{1});
  }
  Bytes bytes = message.bytes();
  const auto damage = *rc::gen::container<std::map<std::size_t, std::uint8_t>>(
      rc::gen::inRange<std::size_t>(4, bytes.size()), rc::gen::inRange<std::uint8_t>(0, 20));
  for (const auto& [place, value] : damage) {
    bytes[place] = std::byte{value};
  }
  Collector collector(type);
  const std::string refusal =
      message_of<InputError>([&] { bag::visit_numbers(type, bytes, collector); });
  RC_CLASSIFY(refusal.empty(), "read");
  RC_ASSERT(collector.values.size() <= bytes.size());
  if (refusal.empty()) {
    RC_ASSERT(collector.values.size() >= 5U);  // the flags are always there
    RC_ASSERT(!damage.empty() || collector.values.at("parts[1].v[0]") == -2.5);
  } else {
    RC_ASSERT(!damage.empty());
    RC_ASSERT(refusal.starts_with("byte "));
    RC_ASSERT(std::stoul(refusal.substr(5)) <= bytes.size());
  }
}

}  // namespace
}  // namespace kelpie::cdr_test
