// SPDX-License-Identifier: Apache-2.0
#include "kelpie/core/archive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::archive_test {
namespace {

using testing::message_of;

struct Inner {
  double value = 0.0;
  std::vector<double> list;

  void visit(Archive& archive) {
    archive.number(value);
    archive.list(list, 3, [&](double& item) { archive.number(item); });
  }
};

struct Outer {
  Inner inner;
  int count = 0;
  std::uint8_t small = 0;
  bool flag = false;
  float single = 0.0F;
  double strange = 0.0;
  std::string text;

  void visit(Archive& archive) {
    archive.part("inner", inner);
    archive.whole(count, -5, 5);
    archive.whole(small);
    archive.flag(flag);
    archive.numbers({&single, 1});
    archive.any_number(strange);
    archive.text(text);
  }
};

std::string saved(Outer object) {
  Archive archive;
  object.visit(archive);
  return archive.bytes();
}

Outer loaded(const std::string& bytes) {
  Outer object;
  Archive archive(bytes);
  object.visit(archive);
  archive.finish();
  return object;
}

Outer example() {
  return {{-0.0, {1.0, 2.5}}, -3, 7, true, 0.1F, std::numeric_limits<double>::infinity(), "ξ"};
}

TEST(Archive, WhatIsLoadedIsWhatWasSaved) {
  const Outer outer = loaded(saved(example()));
  EXPECT_TRUE(std::signbit(outer.inner.value));
  EXPECT_EQ(outer.inner.list, (std::vector<double>{1.0, 2.5}));
  EXPECT_EQ(outer.count, -3);
  EXPECT_EQ(outer.small, 7);
  EXPECT_TRUE(outer.flag);
  EXPECT_EQ(outer.single, 0.1F);
  EXPECT_TRUE(std::isinf(outer.strange));
  EXPECT_EQ(outer.text, "ξ");
}

// The layout is a promise: little-endian, eight bytes a number, four a float.
TEST(Archive, BytesAreAsDocumented) {
  const std::string bytes = saved({{1.0, {}}, 2, 3, true, 1.0F, 0.0, "ab"});
  const std::string zeros(7, '\0');
  EXPECT_EQ(bytes, std::string("\0\0\0\0\0\0\xF0\x3F", 8) + std::string(8, '\0') + "\x02" + zeros +
                       "\x03" + zeros + "\x01" + zeros + std::string("\0\0\x80\x3F", 4) +
                       std::string(8, '\0') + "\x02" + zeros + "ab");
}

TEST(Archive, EveryTruncationAndAnythingMoreIsRefused) {
  const std::string bytes = saved(example());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_NE(message_of<InputError>([&] { loaded(bytes.substr(0, size)); }), "") << size;
  }
  EXPECT_EQ(message_of<InputError>([&] { loaded(bytes + "x"); }),
            "state: more bytes than the state has");
}

TEST(Archive, LengthsAreCheckedBeforeAnythingIsAllocated) {
  std::string bytes = saved(example());
  bytes[8] = '\x04';
  EXPECT_EQ(message_of<InputError>([&] { loaded(bytes); }),
            "state.inner: is longer than there is room for");
  Archive archive(bytes);
  std::vector<double> list;
  EXPECT_NE(
      message_of<InputError>([&] { archive.list(list, Archive::kAnyLength, [](double&) {}); }), "");
  EXPECT_EQ(list.capacity(), 0U);
}

TEST(Archive, NumbersOutOfRangeAreRefused) {
  Outer outer = example();
  outer.inner.value = std::nan("");
  EXPECT_EQ(message_of<InputError>([&] { loaded(saved(outer)); }),
            "state.inner: holds a number that isn't finite");
  outer = example();
  outer.count = 6;
  EXPECT_NE(message_of<InputError>([&] { loaded(saved(outer)); }), "");
  std::string bytes = saved(example());
  bytes[8 + 8 + 16 + 8 + 8] = '\x02';  // the flag
  EXPECT_NE(message_of<InputError>([&] { loaded(bytes); }), "");
}

TEST(Archive, WhatCouldNotBeLoadedIsNotSaved) {
  for (double number : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    Archive archive;
    EXPECT_NO_THROW(archive.any_number(number));
    EXPECT_EQ(testing::message_of<InputError>([&] { archive.number(number); }),
              "state: holds a number that isn't finite");
    auto single = static_cast<float>(number);
    EXPECT_THROW(archive.numbers(std::span(&single, 1)), InputError);
  }
}

TEST(Archive, BothSidesHaveToAgree) {
  Archive saves;
  saves.same("gamma", "0.1");
  Archive loads(saves.bytes());
  EXPECT_EQ(message_of<InputError>([&] { loads.same("gamma", "0.2"); }),
            "gamma: is '0.1' in what was saved, '0.2' here");
}

}  // namespace
}  // namespace kelpie::archive_test
