// SPDX-License-Identifier: Apache-2.0
#include "kelpie/alignment/alignment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <span>
#include <vector>

#include "allocation_count.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::alignment_test {
namespace {

struct Row {
  double velocity = 0.0;
  double command = 0.0;
  double target = 0.0;
  double t = 0.0;
  bool operator==(const Row&) const = default;
};

// Ten rows a second; row i is {i, 100 + i} → −i. A minute passes before row `gap`.
std::vector<Row> log_with_gap(int rows, int gap) {
  std::vector<Row> log;
  log.reserve(static_cast<std::size_t>(rows));
  for (int i = 0; i < rows; ++i) {
    log.push_back({static_cast<double>(i), 100.0 + i, -1.0 * i, 0.1 * i + (i >= gap ? 60.0 : 0.0)});
  }
  return log;
}

std::vector<Row> aligned(const std::vector<Row>& log, int shift) {
  AlignedRows rows(shift, {1}, 2, 1, 10.0);
  std::vector<Row> out;
  const auto take = [&](std::span<const double> x, std::span<const double> y, double t) {
    out.push_back({x[0], x[1], y[0], t});
  };
  for (const Row& row : log) {
    rows.push(std::vector{row.velocity, row.command}, std::vector{row.target}, row.t, take);
  }
  rows.finish(take);
  return out;
}

TEST(AlignedRows, TakesTheNearestCommandsOfTheSameStretchAndKeepsTheRest) {
  constexpr int kRows = 12;
  for (const int gap : {1, 4, kRows}) {
    for (const int shift : {-20, -3, -1, 0, 1, 3, 20}) {
      std::vector<Row> expected = log_with_gap(kRows, gap);
      for (int i = 0; i < kRows; ++i) {
        const int first = i < gap ? 0 : gap;
        const int last = i < gap ? gap - 1 : kRows - 1;
        expected[static_cast<std::size_t>(i)].command = 100.0 + std::clamp(i + shift, first, last);
      }
      EXPECT_EQ(aligned(log_with_gap(kRows, gap), shift), expected) << gap << " " << shift;
    }
  }
}

// A lag runs forwards only: where the clock steps back, a new stretch begins.
TEST(AlignedRows, AnActuatorBeginsAnewWhereTheClockStepsBack) {
  Actuator slow;
  slow.lag_s = 0.2;
  AlignedRows rows(0, {1}, 2, 1, 10.0, std::array{slow});
  for (const double from_s : {10.0, 0.0}) {
    for (int i = 0; i < 20; ++i) {
      const std::vector<double> x{0.0, i % 5 < 2 ? 1.0 : -1.0};
      rows.push(x, std::vector{0.0}, from_s + 0.1 * i,
                [&](std::span<const double> given, auto, double t) {
                  EXPECT_LE(std::abs(given[1]), 1.0) << t;
                });
    }
  }
}

TEST(AlignedRows, GivesARowAsSoonAsItsCommandsHaveCome) {
  AlignedRows rows(2, {1}, 2, 1, 10.0);
  std::vector<double> given;
  for (const Row& row : log_with_gap(5, 5)) {
    rows.push(std::vector{row.velocity, row.command}, std::vector{row.target}, row.t,
              [&](std::span<const double> x, auto, double) { given.push_back(x[0]); });
  }
  EXPECT_EQ(given, (std::vector{0.0, 1.0, 2.0}));
}

TEST(AlignedRows, AllocatesNothing) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  AlignedRows rows(4, {1}, 2, 1, 10.0);
  const std::vector<Row> log = log_with_gap(50, 30);
  double sum = 0.0;
  const auto take = [&](std::span<const double> x, auto, double) { sum += x[1]; };
  const std::size_t before = testing::allocations;
  for (const Row& row : log) {
    rows.push(std::span(&row.velocity, 2), std::span(&row.target, 1), row.t, take);
  }
  rows.finish(take);
  EXPECT_EQ(testing::allocations, before);
  EXPECT_GT(sum, 0.0);
}

TEST(AlignedRows, RefusesARateOrAPlaceThatIsNone) {
  EXPECT_THROW(AlignedRows(1, {1}, 2, 1, 0.0), InputError);
  EXPECT_THROW(AlignedRows(1, {2}, 2, 1, 10.0), InputError);
}

}  // namespace
}  // namespace kelpie::alignment_test
