// SPDX-License-Identifier: Apache-2.0
#include "kelpie/study/offline_matrix.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "small_log.hpp"

namespace kelpie::offline_matrix_test {
namespace {

// Two configurations, 7 and 9, of 500 rows each; the second turns the target round.
Dataset two_configurations() {
  Dataset data = testing::small_log(1000);
  for (std::size_t row = 500; row < 1000; ++row) {
    data.configurations[row] = 9;
    data.targets[row] = -data.targets[row];
  }
  for (std::size_t row = 0; row < 500; ++row) {
    data.configurations[row] = 7;
  }
  return data;
}

const CrossValidationOptions kGrid{.gamma = {0.3, 1.0}, .c = {10.0}, .epsilon = {0.1}, .folds = 3};

TEST(OfflineMatrix, GoodAtHomeAndUselessAbroad) {
  const Dataset data = two_configurations();
  const Split split = make_split(data, {.kind = SplitKind::tail});
  EXPECT_EQ(configurations_of(data), (std::vector<int>{7, 9}));
  const OfflineModel first = train_offline(data, split, 0, 7, kGrid);
  EXPECT_EQ(first.training_rows, 400U);
  EXPECT_GT(first.r2.at(0), 0.85);
  EXPECT_LT(first.r2.at(1), 0.0);
  const OfflineModel second = train_offline(data, split, 0, 9, kGrid);
  EXPECT_LT(second.r2.at(0), 0.0);
  EXPECT_GT(second.r2.at(1), 0.85);
}

TEST(OfflineMatrix, HeldOutRowsHaveNoPartInTheChoice) {
  Dataset data = two_configurations();
  const Split split = make_split(data, {.kind = SplitKind::tail});
  const OfflineModel honest = train_offline(data, split, 0, 7, kGrid);
  for (const std::size_t row : split.held_out) {
    data.targets[row] = 1e6 * static_cast<double>(row);
  }
  const OfflineModel spoilt = train_offline(data, split, 0, 7, kGrid);
  EXPECT_EQ(spoilt.settings.gamma, honest.settings.gamma);
  EXPECT_EQ(spoilt.cross_validated_r2, honest.cross_validated_r2);
  EXPECT_NE(spoilt.r2, honest.r2);
}

}  // namespace
}  // namespace kelpie::offline_matrix_test
