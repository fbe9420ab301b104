// SPDX-License-Identifier: Apache-2.0
#include "lab/cross_validation.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "study/small_log.hpp"

namespace kelpie::offline_matrix_test {
namespace {

// Two configurations, 7 and 9, of 500 rows each; the second turns the target round.
log::Dataset two_configurations() {
  log::Dataset data = testing::small_log(1000);
  for (std::size_t row = 500; row < 1000; ++row) {
    data.configurations[row] = 9;
    data.targets[row] = -data.targets[row];
  }
  for (std::size_t row = 0; row < 500; ++row) {
    data.configurations[row] = 7;
  }
  return data;
}

lab::CrossValidationOptions grid() {
  return {.gamma = {0.3, 1.0}, .c = {10.0}, .epsilon = {0.1}, .folds = 3};
}

TEST(OfflineMatrix, GoodAtHomeAndUselessAbroad) {
  const log::Dataset data = two_configurations();
  const study::Split split = study::make_split(data, {.kind = study::SplitKind::tail});
  EXPECT_EQ(lab::configurations_of(data), (std::vector<int>{7, 9}));
  const lab::OfflineModel first = lab::train_offline(data, split, 0, 7, grid());
  EXPECT_EQ(first.training_rows, 400U);
  EXPECT_GT(first.r2.at(0), 0.85);
  EXPECT_LT(first.r2.at(1), 0.0);
  const lab::OfflineModel second = lab::train_offline(data, split, 0, 9, grid());
  EXPECT_LT(second.r2.at(0), 0.0);
  EXPECT_GT(second.r2.at(1), 0.85);
}

TEST(OfflineMatrix, HeldOutRowsHaveNoPartInTheChoice) {
  log::Dataset data = two_configurations();
  const study::Split split = study::make_split(data, {.kind = study::SplitKind::tail});
  const lab::OfflineModel honest = lab::train_offline(data, split, 0, 7, grid());
  for (const std::size_t row : split.held_out) {
    data.targets[row] = 1e6 * static_cast<double>(row);
  }
  const lab::OfflineModel spoilt = lab::train_offline(data, split, 0, 7, grid());
  EXPECT_EQ(spoilt.settings.gamma, honest.settings.gamma);
  EXPECT_EQ(spoilt.cross_validated_r2, honest.cross_validated_r2);
  EXPECT_NE(spoilt.r2, honest.r2);
}

// Learned at half speed and asked at full speed, where the kernel knows nothing.
TEST(OfflineMatrix, TermsReachBeyondTheRowsLearned) {
  log::Dataset data = testing::small_log(500);
  data.input_names = {"u", "v", "r", "n1"};
  data.inputs.clear();
  for (std::size_t row = 0; row < 500; ++row) {
    const double size = row < 400 ? 1.0 : 2.0;  // the tail is held out
    const auto i = static_cast<double>(row);
    const double u = size * std::sin(0.37 * i);
    const double n = 10.0 * size * std::cos(0.11 * i);
    data.inputs.insert(data.inputs.end(), {u, std::sin(0.7 * i), std::cos(0.5 * i), n});
    data.targets[row] = 0.01 * n * std::abs(n) - u * std::abs(u);
  }
  const study::Split split = study::make_split(data, {.kind = study::SplitKind::tail});
  const double with_terms = lab::train_offline(data, split, 0, 0, grid(), true).r2.at(0);
  EXPECT_GT(with_terms, 0.99);
  EXPECT_LT(lab::train_offline(data, split, 0, 0, grid()).r2.at(0), with_terms - 0.2);
}

}  // namespace
}  // namespace kelpie::offline_matrix_test
