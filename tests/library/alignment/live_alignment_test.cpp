// SPDX-License-Identifier: Apache-2.0
#include "kelpie/alignment/live_alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "alignment/late_log.hpp"
#include "allocation_count.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "support.hpp"

namespace kelpie::live_alignment_test {
namespace {

using testing::LateLog;

const std::vector<std::string> kInputs{"u", "v", "n", "m"};

struct Row {
  std::vector<double> x;
  double t;
};

// Shows a log, looking whenever it is time; how often the shift changed. Rows given go to `rows`.
int show(LiveAlignment& live, const LateLog& log, double begin_s = 0.0,
         std::vector<Row>* rows = nullptr) {
  int changes = 0;
  const auto take = [&](std::span<const double> x, std::span<const double>, double t) {
    if (rows != nullptr) {
      rows->push_back({{x.begin(), x.end()}, t});
    }
  };
  for (std::size_t i = 0; i < log.times.size(); ++i) {
    live.push(std::span(log.inputs).subspan(4 * i, 4), std::span(log.targets).subspan(2 * i, 2),
              begin_s + log.times[i], take);
    if (live.is_due() && live.adopt(live.search())) {
      ++changes;
    }
  }
  return changes;
}

TEST(LiveAlignment, FindsTheShiftOnceAndGivesTheRowsThatBelongTogether) {
  for (const int late : {-4, 0, 3}) {
    LiveAlignment live(kInputs, 2, 10.0);
    const LateLog log(late, 6000);
    std::vector<Row> rows;
    EXPECT_EQ(show(live, log, 0.0, &rows), late == 0 ? 0 : 1);
    EXPECT_EQ(live.alignment().rows, late);
    EXPECT_DOUBLE_EQ(live.alignment().lag_s, 0.1 * late);
    // The last rows given have the commands of the rows where they were logged.
    for (std::size_t i = rows.size() - 1000; i < rows.size(); ++i) {
      const auto own = static_cast<std::size_t>(std::lround(10.0 * rows[i].t));
      const std::size_t from = own + static_cast<std::size_t>(late);
      ASSERT_EQ(rows[i].x[0], log.inputs[4 * own]);
      ASSERT_EQ(rows[i].x[2], log.inputs[4 * from + 2]);
    }
  }
}

// As a log does: no shift is in use that another would have to be clearly better than.
TEST(LiveAlignment, LookedAtAfreshItSaysWhatALogOfTheRowsKeptSays) {
  const LateLog log(2, 2000);
  LiveAlignment live(kInputs, 2, 10.0);
  live.adopt(
      {.alignment = {.lag_s = 0.5, .rows = 5, .commands = {"n", "m"}}, .gain = 0.0, .why = {}});
  show(live, log);
  const AlignmentResult afresh = live.search(true);
  const AlignmentResult of_log = find_alignment(log.problem(kInputs));
  EXPECT_EQ(afresh.alignment.rows, of_log.alignment.rows);
  EXPECT_EQ(afresh.why, of_log.why);
}

TEST(LiveAlignment, FollowsAShiftThatChanges) {
  LiveAlignment live(kInputs, 2, 10.0, "auto", 2000);
  show(live, LateLog(2, 3000));
  EXPECT_EQ(live.alignment().rows, 2);
  show(live, LateLog(6, 8000), 1000.0);
  EXPECT_EQ(live.alignment().rows, 6);
  show(live, LateLog(0, 8000), 3000.0);
  EXPECT_EQ(live.alignment().rows, 0);
}

TEST(LiveAlignment, CommandsThatMoveNothingAreNeverShifted) {
  LiveAlignment live(kInputs, 2, 10.0);
  RandomStream random(3, "noise");
  LateLog log(0, 12'000);
  for (double& value : log.inputs) {
    value = random.normal();
  }
  for (double& value : log.targets) {
    value = random.normal();
  }
  EXPECT_EQ(show(live, log), 0);
}

TEST(LiveAlignment, ReplayGivesAllRowsKeptByTheShiftInUse) {
  LiveAlignment live(kInputs, 2, 10.0, "auto", 2000);
  const LateLog log(3, 5000);
  show(live, log);
  std::vector<Row> rows;
  const auto take = [&](std::span<const double> x, std::span<const double>, double t) {
    rows.push_back({{x.begin(), x.end()}, t});
  };
  live.replay(take);
  EXPECT_EQ(rows.size(), 1997U);  // the last three wait for their commands
  live.finish(take);
  ASSERT_EQ(rows.size(), 2000U);
  EXPECT_EQ(rows[0].t, log.times[3000]);
  EXPECT_EQ(rows[0].x[2], log.inputs[std::size_t{4} * 3003 + 2]);
  EXPECT_EQ(rows.back().x[2], log.inputs[std::size_t{4} * 4999 + 2]);
}

TEST(LiveAlignment, ShowingARowAllocatesNothing) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  LiveAlignment live(kInputs, 2, 10.0);
  const LateLog log(3, 2000);
  const auto nothing = [](std::span<const double>, std::span<const double>, double) {};
  const std::size_t before = testing::allocations;
  for (std::size_t i = 0; i < log.times.size(); ++i) {
    live.push(std::span(log.inputs).subspan(4 * i, 4), std::span(log.targets).subspan(2 * i, 2),
              log.times[i], nothing);
  }
  EXPECT_EQ(testing::allocations, before);
  EXPECT_TRUE(live.is_due());
}

TEST(LiveAlignment, RowsWithoutAValueAndTimeThatStepsBackDoNoHarm) {
  LiveAlignment live(kInputs, 2, 10.0);
  std::vector<double> times;
  const auto take = [&](std::span<const double>, std::span<const double>, double t) {
    times.push_back(t);
  };
  EXPECT_TRUE(live.search().alignment.none());
  const std::vector<double> x{1.0, 2.0, 3.0, 4.0};
  const std::vector<double> y{0.0, std::nan("")};
  live.push(x, y, 0.0, take);
  live.push(x, std::vector{0.0, 0.0}, std::nan(""), take);
  EXPECT_TRUE(times.empty());
  show(live, LateLog(3, 3000), 1e6);
  EXPECT_EQ(live.alignment().rows, 3);
  live.push(x, std::vector{0.0, 0.0}, 5.0, take);
  EXPECT_EQ(times.size(), 3U);  // those that waited
  EXPECT_GT(times.back(), 1e6);
  EXPECT_EQ(live.search().alignment.rows, 3);
}

TEST(LiveAlignment, WhatCannotBeIsRefused) {
  EXPECT_NE(testing::message_of<InputError>([] { LiveAlignment(kInputs, 2, 0.0); }), "");
  EXPECT_EQ(testing::message_of<InputError>([] { LiveAlignment(kInputs, 2, 10.0, "auto", 10); }),
            "keep: has to be 1500 rows or more");
  EXPECT_NE(testing::message_of<InputError>([] { LiveAlignment(kInputs, 2, 10.0, "a,b"); }), "");
}

}  // namespace
}  // namespace kelpie::live_alignment_test
