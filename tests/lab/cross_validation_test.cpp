// SPDX-License-Identifier: Apache-2.0
#include "lab/cross_validation.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "kelpie/core/error.hpp"
#include "lab/logs.hpp"
#include "support.hpp"

namespace kelpie::cross_validation_test {
namespace {

using testing::Log;

lab::CrossValidationOptions small_grid() {
  lab::CrossValidationOptions options;
  options.gamma = {0.001, 0.3, 300.0};
  options.c = {1.0, 10.0};
  options.epsilon = {0.05, 3.0};
  return options;
}

std::vector<double> scores(const lab::CrossValidation& result) {
  std::vector<double> r2;
  r2.reserve(result.cells.size());
  for (const lab::CrossValidationCell& cell : result.cells) {
    r2.push_back(cell.r2);
  }
  return r2;
}

// The outcome by hand: every fold trained on the others and judged.
TEST(CrossValidation, ScoresACellAsItsDefinitionDoes) {
  const Log log(1, 90);
  lab::CrossValidationOptions options;
  options.gamma = {0.3};
  options.c = {10.0};
  options.epsilon = {0.1};
  options.folds = 3;
  const lab::CrossValidation result = lab::cross_validate(log.view(), {}, options);
  double squared = 0.0;
  double mean = 0.0;
  for (std::size_t fold = 0; fold < 3; ++fold) {
    Log others = log;
    others.rows.erase(others.rows.begin() + static_cast<std::ptrdiff_t>(30 * fold),
                      others.rows.begin() + static_cast<std::ptrdiff_t>(30 * (fold + 1)));
    const lab::OfflineSvr svr(others.view(), {.gamma = 0.3});
    for (std::size_t i = 30 * fold; i < 30 * (fold + 1); ++i) {
      squared += std::pow(svr.predict(log.view().input(i)) - log.y[i], 2);
      mean += log.y[i] / 90.0;
    }
  }
  double total = 0.0;
  for (const double y : log.y) {
    total += std::pow(y - mean, 2);
  }
  ASSERT_EQ(result.cells.size(), 1U);
  EXPECT_NEAR(result.r2, 1.0 - squared / total, 1e-12);
}

TEST(CrossValidation, PicksTheCellThatGeneralises) {
  const Log log(2, 200);
  const lab::CrossValidation result = lab::cross_validate(log.view(), {}, small_grid());
  EXPECT_EQ(result.cells.size(), 12U);
  EXPECT_EQ(result.best.gamma, 0.3);
  EXPECT_EQ(result.best.epsilon, 0.05);
  EXPECT_GT(result.r2, 0.9);
  for (const lab::CrossValidationCell& cell : result.cells) {
    EXPECT_LE(cell.r2, result.r2);
  }
}

TEST(CrossValidation, ReadsNoRowThatIsHeldOut) {
  Log log(3, 250);
  std::vector<std::size_t> training;
  for (std::size_t i = 0; i < 250; ++i) {
    if (i / 10 % 5 != 4) {
      training.push_back(i);
    }
  }
  log.rows = training;
  const std::vector<double> before = scores(lab::cross_validate(log.view(), {}, small_grid()));
  log.poison_all_but(training);
  EXPECT_EQ(scores(lab::cross_validate(log.view(), {}, small_grid())), before);
}

TEST(CrossValidation, IsTheSameForAnyNumberOfThreads) {
  const Log log(4, 150);
  lab::CrossValidationOptions options = small_grid();
  const lab::CrossValidation one = lab::cross_validate(log.view(), {}, options);
  options.threads = 2;
  const lab::CrossValidation two = lab::cross_validate(log.view(), {}, options);
  EXPECT_EQ(scores(one), scores(two));
  EXPECT_EQ(one.best.gamma, two.best.gamma);
  EXPECT_EQ(one.best.c, two.best.c);
}

TEST(CrossValidation, ThinningUsesEveryThinthRow) {
  Log log(5, 200);
  lab::CrossValidationOptions options = small_grid();
  options.thin = 4;
  const lab::CrossValidation thinned = lab::cross_validate(log.view(), {}, options);
  EXPECT_EQ(thinned.rows_used, 50U);
  std::vector<std::size_t> fourth;
  for (std::size_t i = 0; i < 200; i += 4) {
    fourth.push_back(i);
  }
  log.rows = fourth;
  EXPECT_EQ(scores(thinned), scores(lab::cross_validate(log.view(), {}, small_grid())));
}

TEST(CrossValidation, SaysWhatIsWrong) {
  Log log(6, 30);
  lab::CrossValidationOptions options = small_grid();
  const auto message = [&] {
    return testing::message_of<InputError>([&] { lab::cross_validate(log.view(), {}, options); });
  };
  options.c = {};
  EXPECT_EQ(message(), "c: no values to try; there has to be one or more");
  options.c = {1.0};
  options.folds = 20;
  EXPECT_EQ(message(), "folds: 30 rows for 20 folds; there have to be 40 or more");
  options.folds = 5;
  options.threads = 2;  // what goes wrong in a thread is heard of
  log.y[12] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(message(), "rows: row 12 holds a value that is not finite");
}

}  // namespace
}  // namespace kelpie::cross_validation_test
