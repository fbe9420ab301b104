// SPDX-License-Identifier: Apache-2.0
#include "simulator/excitation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "kelpie/core/error.hpp"

namespace kelpie::excitation_test {
namespace {

const Eigen::Vector3d kMaxSpeeds(12.5, 12.5, 10.9);

std::vector<Eigen::Vector3d> commands(const simulator::ExcitationSettings& settings,
                                      std::uint64_t seed, double duration_s, double amplitude = 1.0,
                                      double step_s = 0.1) {
  simulator::Excitation excitation(settings, kMaxSpeeds, seed);
  std::vector<Eigen::Vector3d> rows(static_cast<std::size_t>(std::lround(duration_s / step_s)));
  for (Eigen::Vector3d& row : rows) {
    row = excitation.advance(step_s, amplitude);
  }
  return rows;
}

double correlation(const std::vector<Eigen::Vector3d>& rows, int a, int b) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& row : rows) {
    mean += row / static_cast<double>(rows.size());
  }
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const auto& row : rows) {
    sum += (row - mean) * (row - mean).transpose();
  }
  return sum(a, b) / std::sqrt(sum(a, a) * sum(b, b));
}

// Judged by the commands alone: the time from one upward crossing of zero to the next is a period.
TEST(Excitation, PeriodsAreSpreadEvenlyFrom20To70Seconds) {
  const auto rows = commands({}, 1, 40000.0);
  for (int thruster = 0; thruster < 3; ++thruster) {
    std::vector<double> crossings;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      const double before = rows[i - 1](thruster), now = rows[i](thruster);
      if (before < 0.0 && now >= 0.0) {
        crossings.push_back(0.1 * (static_cast<double>(i) - now / (now - before)));
      }
    }
    double sum = 0.0, squares = 0.0;
    double shortest = 1e9, longest = 0.0;
    for (std::size_t i = 1; i < crossings.size(); ++i) {
      const double period = crossings[i] - crossings[i - 1];
      sum += period;
      squares += period * period;
      shortest = std::min(shortest, period);
      longest = std::max(longest, period);
    }
    const auto count = static_cast<double>(crossings.size() - 1);
    const double mean = sum / count;
    EXPECT_GT(shortest, 20.0 - 0.1);
    EXPECT_LT(shortest, 21.0);
    EXPECT_LT(longest, 70.0 + 0.1);
    EXPECT_GT(longest, 69.0);
    EXPECT_NEAR(mean, 45.0, 2.0);
    EXPECT_NEAR(std::sqrt(squares / count - mean * mean), 50.0 / std::sqrt(12.0), 1.0);
  }
}

TEST(Excitation, ReachesTheGreatestSpeedsAndNoMore) {
  for (const simulator::ExcitationMode mode :
       {simulator::ExcitationMode::independent, simulator::ExcitationMode::correlated}) {
    Eigen::Vector3d greatest = Eigen::Vector3d::Zero();
    for (const auto& row : commands({.mode = mode}, 3, 40000.0)) {
      greatest = greatest.cwiseMax(row.cwiseAbs());
    }
    EXPECT_TRUE(((kMaxSpeeds - greatest).array() >= -1e-12).all());
    EXPECT_TRUE((greatest.array() > 0.98 * kMaxSpeeds.array()).all());
  }
}

TEST(Excitation, AmplitudeScalesTheSameCommands) {
  const auto full = commands({}, 4, 200.0);
  const auto low = commands({}, 4, 200.0, 0.25);
  for (std::size_t i = 0; i < full.size(); ++i) {
    EXPECT_LT((low[i] - 0.25 * full[i]).norm(), 1e-12);
  }
}

TEST(Excitation, ThrustersAreIndependentOrCorrelatedAsAsked) {
  constexpr double kStep = 1.0;  // a twentieth of the shortest period
  const auto independent = commands({}, 5, 100000.0, 1.0, kStep);
  EXPECT_NEAR(correlation(independent, 0, 1), 0.0, 0.05);
  EXPECT_NEAR(correlation(independent, 0, 2), 0.0, 0.05);
  const auto correlated =
      commands({.mode = simulator::ExcitationMode::correlated}, 5, 100000.0, 1.0, kStep);
  EXPECT_NEAR(correlation(correlated, 0, 1), 0.78, 0.03);
  EXPECT_NEAR(correlation(correlated, 0, 2), 0.0, 0.05);
}

TEST(Excitation, SeedDecidesEverything) {
  EXPECT_EQ(commands({}, 6, 500.0), commands({}, 6, 500.0));
  EXPECT_NE(commands({}, 6, 500.0), commands({}, 7, 500.0));
}

TEST(Excitation, ValidateNamesTheKey) {
  const auto field = [](const simulator::ExcitationSettings& settings) {
    try {
      settings.validate();
    } catch (const InputError& error) {
      return error.place().field;
    }
    return std::string();
  };
  EXPECT_EQ(field({}), "");
  EXPECT_EQ(field({.shortest_period_s = 70.0, .longest_period_s = 20.0}), "excitation.period_s");
  EXPECT_EQ(field({.shortest_period_s = 0.0}), "excitation.period_s");
  EXPECT_EQ(field({.correlation = 1.5}), "excitation.correlation");
  EXPECT_THROW(simulator::excitation_mode_from("corelated"), InputError);
}

}  // namespace
}  // namespace kelpie::excitation_test
