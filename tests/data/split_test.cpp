// SPDX-License-Identifier: Apache-2.0
#include "kelpie/data/split.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <vector>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie {
namespace {

using testing::message_of;

Dataset rows_of(const std::vector<int>& configurations) {
  Dataset data;
  data.source = "log.csv";
  data.configurations = configurations;
  data.times_s.resize(configurations.size());
  return data;
}

RC_GTEST_PROP(Split, IsAPartitionInTimeOrderOfEveryConfiguration, ()) {
  const auto configurations = *rc::gen::container<std::vector<int>>(
      *rc::gen::inRange<std::size_t>(60, 200), rc::gen::inRange(0, 3));
  SplitSettings settings;
  settings.kind = *rc::gen::element(SplitKind::random, SplitKind::blocks, SplitKind::tail);
  settings.block_rows = 2;
  const Dataset data = rows_of(configurations);
  const auto rows_in = [&](const std::vector<std::size_t>& rows, int configuration) {
    return std::ranges::count_if(
        rows, [&](std::size_t row) { return configurations[row] == configuration; });
  };
  try {
    const Split split = make_split(data, settings);
    RC_ASSERT(std::ranges::is_sorted(split.training));
    RC_ASSERT(std::ranges::is_sorted(split.held_out));
    std::vector<std::size_t> all = split.training;
    all.insert(all.end(), split.held_out.begin(), split.held_out.end());
    std::ranges::sort(all);
    for (std::size_t row = 0; row < configurations.size(); ++row) {
      RC_ASSERT(all[row] == row);
    }
    for (const int configuration : configurations) {
      RC_ASSERT(rows_in(split.training, configuration) > 0);
      RC_ASSERT(rows_in(split.held_out, configuration) > 0);
    }
  } catch (const InputError&) {
    RC_ASSERT(std::ranges::any_of(std::vector{0, 1, 2}, [&](int configuration) {
      const auto rows = std::ranges::count(configurations, configuration);
      return rows > 0 && rows < 9;
    }));
  }
}

TEST(Split, HoldsOutWhatItsLabelSays) {
  const Dataset data = rows_of(std::vector<int>(1000, 0));
  const Split tail = make_split(data, {.kind = SplitKind::tail});
  EXPECT_EQ(tail.held_out.size(), 200U);
  EXPECT_EQ(tail.held_out.front(), 800U);
  const Split blocks = make_split(data, {.kind = SplitKind::blocks, .block_rows = 100});
  ASSERT_EQ(blocks.held_out.size(), 200U);
  EXPECT_EQ(blocks.held_out.front(), 400U);
  EXPECT_EQ(blocks.held_out[99], 499U);
  EXPECT_EQ(blocks.held_out[100], 900U);
  EXPECT_EQ(blocks.label, "blocks of 100 rows, one in 5 held out");
  const Split random = make_split(data, {.kind = SplitKind::random});
  EXPECT_EQ(random.held_out.size(), 200U);
  EXPECT_NE(random.label.find("leak"), std::string::npos);
}

TEST(Split, RandomDependsOnTheSeedAlone) {
  const Dataset data = rows_of(std::vector<int>(500, 0));
  const auto held_out = [&](std::uint64_t seed) {
    return make_split(data, {.kind = SplitKind::random, .seed = seed}).held_out;
  };
  EXPECT_EQ(held_out(1), held_out(1));
  EXPECT_NE(held_out(1), held_out(2));
}

TEST(Split, RefusesTooFewRowsAndBadSettings) {
  EXPECT_EQ(message_of<InputError>([] {
              make_split(rows_of({0, 0, 0}), {});
            }),
            "log.csv: split: configuration 0 has 3 rows; blocks of 400 rows, one in 5 held out "
            "needs 1601 or more");
  EXPECT_NE(message_of<InputError>([] { SplitSettings{.held_out = 1.0}.validate(); }), "");
  EXPECT_NE(message_of<InputError>([] { SplitSettings{.block_rows = 0}.validate(); }), "");
  EXPECT_NE(message_of<InputError>([] { SplitSettings{.every = 1}.validate(); }), "");
  EXPECT_EQ(message_of<InputError>([] { split_kind_from("block"); }),
            "split: 'block' is not one of random, blocks, tail (did you mean 'blocks'?)");
}

}  // namespace
}  // namespace kelpie
