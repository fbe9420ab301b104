// SPDX-License-Identifier: Apache-2.0
#include "study/baselines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "kelpie/core/random.hpp"
#include "study/result.hpp"

namespace kelpie::baselines_test {
namespace {

// A vehicle that least squares knows whole: a = n|n| / 100 − 2 u|u| − 0.3 u.
log::Dataset drive(std::size_t rows, const std::string& velocity, const std::string& thruster) {
  RandomStream random(1, "drive");
  log::Dataset data;
  data.input_names = {velocity, thruster};
  data.target_names = {"acceleration"};
  double u = 0.0;
  double phase = 0.0;
  for (std::size_t row = 0; row < rows; ++row) {
    phase += random.uniform(0.01, 0.05);
    const double n = 10.0 * std::sin(phase);
    const double a = 0.01 * n * std::abs(n) - 2.0 * u * std::abs(u) - 0.3 * u;
    data.inputs.insert(data.inputs.end(), {u, n});
    data.targets.push_back(a);
    data.times_s.push_back(0.1 * static_cast<double>(row));
    data.configurations.push_back(0);
    u += 0.1 * a;
  }
  return data;
}

study::Split first_rows_to_learn(std::size_t training, std::size_t rows) {
  study::Split split;
  for (std::size_t row = 0; row < rows; ++row) {
    (row < training ? split.training : split.held_out).push_back(row);
  }
  return split;
}

// Every sample from `first` on is predicted before it is learned.
study::Baselines measured(const log::Dataset& data, const study::Split& split,
                          std::size_t first = 2) {
  study::StreamResult result;
  result.samples_shown = split.training.size();
  result.axes.resize(data.target_names.size());
  std::vector<std::size_t>& samples = result.axes.front().one_step.samples;
  samples.resize(split.training.size() + 1 - first);
  std::iota(samples.begin(), samples.end(), first);
  study::add_baselines(data, split, {}, result);
  return result.axes.front().baselines;
}

TEST(Baselines, OfAFewRowsAreThoseByHand) {
  log::Dataset data = drive(6, "u", "n");
  data.targets = {1.0, 3.0, 5.0, 3.0, 2.0, 6.0};
  const study::Baselines baselines = measured(data, first_rows_to_learn(4, 6));
  // One ahead 3, 5, 3 (mean 11/3, total 8/3): the mean says 1, 2, 3, the last value 1, 3, 5.
  EXPECT_NEAR(baselines.mean.prequential_r2, 1.0 - (4.0 + 9.0 + 0.0) * 3.0 / 8.0, 1e-12);
  EXPECT_NEAR(baselines.last_value.prequential_r2, 1.0 - (4.0 + 4.0 + 4.0) * 3.0 / 8.0, 1e-12);
  // Held out 2, 6 (mean 4, total 8): the mean of what was learned says 3.
  EXPECT_NEAR(baselines.mean.r2_final, 1.0 - (1.0 + 9.0) / 8.0, 1e-12);
  EXPECT_TRUE(std::isnan(baselines.last_value.r2_final));
}

TEST(Baselines, LeastSquaresFindsAVehicleMadeOfItsTerms) {
  const study::Baselines baselines =
      measured(drive(1000, "u", "n"), first_rows_to_learn(800, 1000), 200);
  EXPECT_GT(baselines.least_squares.r2_final, 0.999);
  EXPECT_GT(baselines.least_squares.prequential_r2, 0.99);
}

TEST(Baselines, LeastSquaresTakesACommandThatIsAForce) {
  log::Dataset data = drive(1000, "u", "f");
  for (std::size_t row = 0; row < data.rows(); ++row) {
    const double u = data.input(row)[0];
    data.targets[row] = 0.3 * data.input(row)[1] - 2.0 * u * std::abs(u);
  }
  EXPECT_GT(measured(data, first_rows_to_learn(800, 1000)).least_squares.r2_final, 0.999);
}

TEST(Baselines, LeastSquaresNeedsNoNames) {
  const study::Split split = first_rows_to_learn(800, 1000);
  EXPECT_EQ(measured(drive(1000, "u", "n"), split).least_squares.r2_final,
            measured(drive(1000, "Vx", "left"), split).least_squares.r2_final);
}

TEST(Baselines, WithMoreTermsThanLeastSquaresTakesItIsLeftOut) {
  const std::size_t rows = 50;
  const std::size_t inputs = 64;
  log::Dataset data = drive(rows, "u", "n");
  RandomStream random(2, "inputs");
  data.inputs.resize(rows * inputs);
  std::ranges::generate(data.inputs, [&] { return random.normal(); });
  data.input_names.clear();
  for (std::size_t i = 0; i < inputs; ++i) {
    data.input_names.push_back("x" + std::to_string(i));
  }
  data.target_names = {"a", "b", "c"};
  data.targets.resize(3 * rows);
  std::ranges::generate(data.targets, [&] { return random.normal(); });
  const study::Baselines baselines = measured(data, first_rows_to_learn(40, rows));
  EXPECT_TRUE(std::isnan(baselines.least_squares.r2_final));
  EXPECT_FALSE(std::isnan(baselines.mean.r2_final));
}

}  // namespace
}  // namespace kelpie::baselines_test
