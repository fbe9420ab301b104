// SPDX-License-Identifier: Apache-2.0
#include "study/split.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::split_test {
namespace {

using testing::message_of;
using Rows = std::vector<std::size_t>;

log::Dataset with_configurations(const std::vector<int>& configurations) {
  log::Dataset data;
  data.source = "log.csv";
  data.configurations = configurations;
  data.times_s.resize(configurations.size());
  return data;
}

log::Dataset of_rows(std::size_t rows) {
  return with_configurations(std::vector<int>(rows));
}

study::SplitSettings settings_of(study::SplitKind kind) {
  study::SplitSettings settings;
  settings.kind = kind;
  return settings;
}

study::SplitSettings blocks_of(std::size_t block_rows, std::size_t every) {
  study::SplitSettings settings;
  settings.block_rows = block_rows;
  settings.every = every;
  return settings;
}

std::string refused_field(const study::SplitSettings& settings) {
  try {
    settings.validate();
  } catch (const InputError& error) {
    return error.place().field;
  }
  return "";
}

RC_GTEST_PROP(Split, IsAPartitionOfEveryConfigurationInTimeOrder, ()) {
  auto configurations = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 3));
  for (int configuration = 0; configuration < 3; ++configuration) {
    configurations.insert(configurations.end(), 20, configuration);
  }
  study::SplitSettings settings = blocks_of(*rc::gen::inRange<std::size_t>(1, 6), 3);
  settings.kind = *rc::gen::element(study::SplitKind::random, study::SplitKind::blocks,
                                    study::SplitKind::pieces, study::SplitKind::tail);
  settings.held_out = *rc::gen::element(0.1, 0.2, 0.5, 0.9);
  settings.seed = *rc::gen::arbitrary<std::uint64_t>();
  const study::Split split = study::make_split(with_configurations(configurations), settings);

  RC_ASSERT(std::ranges::is_sorted(split.training));
  RC_ASSERT(std::ranges::is_sorted(split.held_out));
  Rows all;
  std::ranges::merge(split.training, split.held_out, std::back_inserter(all));
  Rows expected(configurations.size());
  std::iota(expected.begin(), expected.end(), std::size_t{0});
  RC_ASSERT(all == expected);
  for (int configuration = 0; configuration < 3; ++configuration) {
    const auto is_of = [&](std::size_t row) { return configurations[row] == configuration; };
    const auto held_out = std::ranges::count_if(split.held_out, is_of);
    RC_ASSERT(held_out > 0);
    RC_ASSERT(std::ranges::any_of(split.training, is_of));
    if (settings.kind == study::SplitKind::random || settings.kind == study::SplitKind::tail) {
      const auto rows = static_cast<double>(std::ranges::count(configurations, configuration));
      RC_ASSERT(held_out == static_cast<std::ptrdiff_t>(settings.held_out * rows));
    }
  }
}

TEST(Split, RandomIsTheSameForTheSameSeedOnly) {
  study::SplitSettings settings = settings_of(study::SplitKind::random);
  const study::Split one = study::make_split(of_rows(1000), settings);
  EXPECT_EQ(one.held_out.size(), 200U);
  EXPECT_EQ(one.held_out, study::make_split(of_rows(1000), settings).held_out);
  settings.seed = 2;
  EXPECT_NE(one.held_out, study::make_split(of_rows(1000), settings).held_out);
}

TEST(Split, RandomTakesFromEverywhere) {
  const study::Split split =
      study::make_split(of_rows(10000), settings_of(study::SplitKind::random));
  for (std::size_t tenth = 0; tenth < 10; ++tenth) {  // 200 each; 4.5 standard deviations
    const auto count =
        std::ranges::count_if(split.held_out, [&](std::size_t row) { return row / 1000 == tenth; });
    EXPECT_NEAR(static_cast<double>(count), 200.0, 55.0) << tenth;
  }
}

TEST(Split, BlocksHoldOutTheLastOfEveryFew) {
  const study::Split split = study::make_split(of_rows(11), blocks_of(2, 3));
  EXPECT_EQ(split.held_out, (Rows{4, 5, 10}));  // the last block is cut short
  EXPECT_EQ(split.training, (Rows{0, 1, 2, 3, 6, 7, 8, 9}));
}

TEST(Split, BlocksAreCountedWithinAConfiguration) {
  const study::Split split =
      study::make_split(with_configurations({1, 2, 1, 2, 1, 2, 1, 2}), blocks_of(1, 2));
  EXPECT_EQ(split.held_out, (Rows{2, 3, 6, 7}));
}

TEST(Split, PiecesAreTwentyFiveOfEqualLengthOfEveryConfiguration) {
  std::vector<int> configurations(50, 1);
  configurations.resize(75, 2);
  const study::Split split =
      study::make_split(with_configurations(configurations), settings_of(study::SplitKind::pieces));
  EXPECT_EQ(split.held_out, (Rows{8, 9, 18, 19, 28, 29, 38, 39, 48, 49, 54, 59, 64, 69, 74}));
  EXPECT_THROW(study::make_split(of_rows(1), settings_of(study::SplitKind::pieces)), InputError);
}

TEST(Split, TailIsTheEndOfEveryConfiguration) {
  study::SplitSettings settings = settings_of(study::SplitKind::tail);
  settings.held_out = 0.4;
  const study::Split split =
      study::make_split(with_configurations({0, 0, 0, 7, 0, 0, 7, 7}), settings);
  EXPECT_EQ(split.held_out, (Rows{4, 5, 7}));
}

TEST(Split, NoneHoldsNothingOutAndWhoJudgesSaysSo) {
  const study::Split split =
      study::make_split(with_configurations({0, 0, 1}), settings_of(study::SplitKind::none));
  EXPECT_EQ(split.training, (Rows{0, 1, 2}));
  EXPECT_TRUE(split.held_out.empty());
  EXPECT_THROW(study::require_held_out(split), InputError);
  EXPECT_NO_THROW(study::require_held_out(
      study::make_split(of_rows(100), settings_of(study::SplitKind::tail))));
}

TEST(Split, LabelsSayInPlainWordsWhatWasDone) {
  const auto label = [](study::SplitKind kind) {
    return study::make_split(of_rows(2000), settings_of(kind)).label;
  };
  EXPECT_EQ(label(study::SplitKind::blocks), "blocks of 400 rows, the last of every 5 held out");
  EXPECT_EQ(label(study::SplitKind::tail), "last 20 % of the rows held out");
  EXPECT_EQ(label(study::SplitKind::random),
            "random 20 % of the rows held out (neighbours in time leak)");
  study::SplitSettings odd = settings_of(study::SplitKind::tail);
  odd.held_out = 0.07;  // 100 times this is 7.000000000000001
  EXPECT_EQ(study::make_split(of_rows(100), odd).label, "last 7 % of the rows held out");
}

TEST(Split, ATooShortConfigurationIsToldHowManyRowsItNeeds) {
  std::vector<int> configurations(1700, 0);
  configurations.resize(1800, 3);
  EXPECT_EQ(message_of<InputError>([&] {
              study::make_split(with_configurations(configurations),
                                settings_of(study::SplitKind::blocks));
            }),
            "log.csv: split: configuration 3 has 100 rows; 'blocks of 400 rows, the last of every "
            "5 held out' needs 1601 or more");
  for (const study::SplitKind kind : {study::SplitKind::random, study::SplitKind::tail}) {
    EXPECT_THROW(study::make_split(of_rows(4), settings_of(kind)), InputError);
    EXPECT_NO_THROW(study::make_split(of_rows(5), settings_of(kind)));
  }
  EXPECT_THROW(study::make_split(of_rows(1600), settings_of(study::SplitKind::blocks)), InputError);
  EXPECT_NO_THROW(study::make_split(of_rows(1601), settings_of(study::SplitKind::blocks)));
  EXPECT_THROW(study::make_split(of_rows(0), {}), InputError);
}

TEST(Split, AbsurdSettingsAreRefusedInWords) {
  constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max();
  EXPECT_THROW(study::make_split(of_rows(100), blocks_of(kMost, kMost)), InputError);
  study::SplitSettings settings = settings_of(study::SplitKind::tail);
  settings.held_out = std::numeric_limits<double>::denorm_min();
  EXPECT_THROW(study::make_split(of_rows(100), settings), InputError);
}

TEST(Split, SettingsOutOfRangeAreNamed) {
  EXPECT_EQ(refused_field({}), "");
  for (const double share : {0.0, 1.0, -0.5, std::numeric_limits<double>::quiet_NaN()}) {
    study::SplitSettings settings;
    settings.held_out = share;
    EXPECT_EQ(refused_field(settings), "held_out") << share;
  }
  EXPECT_EQ(refused_field(blocks_of(0, 5)), "block_rows");
  EXPECT_EQ(refused_field(blocks_of(400, 1)), "every");
  EXPECT_EQ(refused_field(blocks_of(400, 0)), "every");
}

TEST(Split, KindsGoByTheirNames) {
  for (const study::SplitKind kind :
       {study::SplitKind::random, study::SplitKind::blocks, study::SplitKind::pieces,
        study::SplitKind::tail, study::SplitKind::none}) {
    EXPECT_EQ(study::parse_split(study::to_string(kind), 7).kind, kind);
    EXPECT_EQ(study::parse_split(study::to_string(kind), 7).seed, 7U);
  }
  EXPECT_EQ(study::parse_split("column:a:b", 1).column, "a:b");
  const auto refusal = [](const std::string& text) {
    return message_of<InputError>([&] { study::parse_split(text, 1); });
  };
  EXPECT_EQ(
      refusal("block"),
      "split: 'block' is no split (did you mean 'blocks'?); there are random, blocks, pieces, "
      "tail, column:NAME, none, auto");
  EXPECT_EQ(refusal("tail:held"), "split: 'tail' takes nothing after a colon");
  for (const std::string text : {"column", "column:"}) {
    EXPECT_EQ(refusal(text),
              "split: 'column' needs the name of a column of 0 and 1, as in column:held");
  }
}

TEST(Split, AColumnHoldsOutTheRowsItMarks) {
  log::Dataset data = with_configurations({0, 0, 1, 1, 0, 1});
  data.held_out = {true, false, false, true, false, true};
  const study::Split split = study::make_split(data, study::parse_split("column:held", 1));
  EXPECT_EQ(split.held_out, (Rows{0, 3, 5}));
  EXPECT_EQ(split.training, (Rows{1, 2, 4}));
  EXPECT_EQ(split.label, "rows marked in column 'held' held out");
}

TEST(Split, AColumnHasToMarkRowsOfEveryConfiguration) {
  log::Dataset data = with_configurations({0, 0, 1, 1});
  data.held_out = {true, false, true, true};
  EXPECT_EQ(message_of<InputError>(
                [&] { study::make_split(data, study::parse_split("column:held", 1)); }),
            "log.csv: held: marks 2 of the 2 rows of configuration 1; both 0 (to learn) and 1 "
            "(held out) are needed");
}

}  // namespace
}  // namespace kelpie::split_test
