// SPDX-License-Identifier: Apache-2.0
#include "posterior/posterior.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/QR>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "kelpie/core/random.hpp"
#include "saved_state.hpp"

namespace kelpie::posterior_test {
namespace {

// The constant, three features that matter and three that don't.
constexpr std::size_t kFeatures = 7;
constexpr std::array<double, kFeatures> kTruth{5.0, 2.0, -1.0, 0.5, 0.0, 0.0, 0.0};
constexpr std::array<std::uint8_t, kFeatures> kGroups{FeatureGroup::kFlat, 1, 1, 1, 2, 2, 2};

constexpr double kAll = std::numeric_limits<double>::infinity();

struct Row {
  std::vector<double> phi;
  double y = 0.0;
};

std::vector<Row> rows(std::uint64_t seed, std::size_t count, double noise) {
  RandomStream random(seed, "posterior");
  std::vector<Row> rows(count);
  for (Row& row : rows) {
    row.phi.push_back(1.0);
    for (std::size_t i = 1; i < kFeatures; ++i) {
      row.phi.push_back(random.normal() * std::pow(10.0, static_cast<double>(i) - 3.0));
    }
    for (std::size_t i = 0; i < kFeatures; ++i) {
      row.y += kTruth[i] * row.phi[i];
    }
    row.y += noise * random.normal();
  }
  return rows;
}

void solve(Posterior& posterior) {
  Budget budget;
  while (!posterior.solve(kGroups, budget)) {
  }
}

void learn(Posterior& posterior, const Row& row) {
  posterior.add(row.phi, row.y, 1.0, Likelihood::student);
  if (posterior.wants_solve()) {
    solve(posterior);
  }
}

Posterior learned(const std::vector<Row>& rows, std::size_t first = 4) {
  Posterior posterior(kFeatures, first);
  for (const Row& row : rows) {
    learn(posterior, row);
  }
  solve(posterior);
  return posterior;
}

TEST(Posterior, FindsTheWeightsWithinTheirStandardErrors) {
  double square = 0.0;
  constexpr int kRuns = 20;
  for (int run = 0; run < kRuns; ++run) {
    const Posterior posterior = learned(rows(static_cast<std::uint64_t>(run), 400, 0.3));
    for (std::size_t i = 1; i < 4; ++i) {
      const double off = (posterior.weights()[i] - kTruth[i]) / posterior.error(i);
      square += off * off / (3.0 * kRuns);
    }
    EXPECT_NEAR(std::sqrt(posterior.noise()), 0.3, 0.06);
  }
  // Errors of Student's likelihood on Gaussian noise, one run in three counted as three samples.
  EXPECT_GT(square, 0.4);
  EXPECT_LT(square, 1.6);
}

// With few samples the evidence holds back what least squares fit to the noise.
TEST(Posterior, PredictsBetterThanLeastSquaresOfFewSamples) {
  double ahead = 0.0;
  for (std::uint64_t run = 0; run < 20; ++run) {
    const std::vector<Row> data = rows(run, 20, 1.0);
    const Posterior posterior = learned(data);
    Eigen::MatrixXd phi(static_cast<Eigen::Index>(data.size()), kFeatures);
    Eigen::VectorXd y(static_cast<Eigen::Index>(data.size()));
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      const Row& row = data[static_cast<std::size_t>(i)];
      phi.row(i) = Eigen::Map<const Eigen::RowVectorXd>(row.phi.data(), kFeatures);
      y[i] = row.y;
    }
    const Eigen::VectorXd least_squares = phi.colPivHouseholderQr().solve(y);
    for (const Row& row : rows(run + 100, 100, 0.0)) {
      const Eigen::Map<const Eigen::VectorXd> at(row.phi.data(), kFeatures);
      ahead += std::pow(row.y - at.dot(least_squares), 2) -
               std::pow(row.y - value(posterior, row.phi), 2);
    }
  }
  EXPECT_GT(ahead, 0.0);
}

// At rest a target may be a constant to the last bit; the vehicle learns when it sets off.
TEST(Posterior, LearnsAfterAConstantTarget) {
  Posterior posterior(kFeatures, 4);
  for (int i = 0; i < 100; ++i) {
    learn(posterior, {{1, 0, 0, 0, 0, 0, 0}, 0.7});
  }
  EXPECT_FALSE(posterior.ready());
  EXPECT_NEAR(posterior.centre(), 0.7, 1e-12);
  for (const Row& row : rows(2, 600, 0.1)) {
    learn(posterior, row);
  }
  EXPECT_NEAR(posterior.weights()[3], kTruth[3], 0.05);
}

// Nothing depends on the units of the log.
TEST(Posterior, IsTheSameInOtherUnits) {
  const std::vector<Row> data = rows(2, 300, 0.3);
  std::vector<Row> others = data;
  for (Row& row : others) {
    row.y = 1e6 * row.y - 3e6;
    for (std::size_t i = 1; i < kFeatures; ++i) {
      row.phi[i] *= i % 2 == 0 ? 1e-4 : 1e3;
    }
  }
  const Posterior one = learned(data);
  const Posterior other = learned(others);
  for (std::size_t i = 0; i < 20; ++i) {
    const double expected = 1e6 * value(one, data[i].phi) - 3e6;
    EXPECT_NEAR(value(other, others[i].phi), expected, 1e-6 * std::abs(expected));
  }
  EXPECT_NEAR(other.rows_per_sample(), one.rows_per_sample(), 1e-6);
}

TEST(Posterior, OutliersHardlyMoveIt) {
  std::vector<Row> data = rows(3, 600, 0.3);
  for (std::size_t i = 100; i < data.size(); i += 50) {
    data[i].y += 60.0;  // 200 standard deviations, always to the same side
  }
  const Posterior posterior = learned(data);
  EXPECT_NEAR(posterior.weights()[3], kTruth[3], 0.1);
  // Least squares would be off by 1.
  EXPECT_NEAR(value(posterior, std::vector<double>{1, 0, 0, 0, 0, 0, 0}), kTruth[0], 0.2);
}

// A command that steps once in a hundred rows, far beyond its usual size, is no outlier.
TEST(Posterior, LearnsRareManoeuvres) {
  RandomStream random(11, "rare");
  Posterior posterior(kFeatures, 4);
  for (int i = 0; i < 2000; ++i) {
    Row row{{1.0, random.normal(), i % 100 == 99 ? 30.0 : 0.1 * random.normal(), 0, 0, 0, 0}, 0.0};
    row.y = row.phi[1] + 2.0 * row.phi[2] + 0.1 * random.normal();
    learn(posterior, row);
  }
  EXPECT_NEAR(posterior.weights()[2], 2.0, 0.05);
}

// A budget cuts a solve anywhere: the results are those of one piece, to the last bit.
TEST(Posterior, SlicesLeaveTheResultsUnchanged) {
  Posterior whole = learned(rows(4, 200, 0.3));
  Posterior sliced = whole;
  ASSERT_EQ(testing::saved(whole), testing::saved(sliced));
  for (const Row& row : rows(5, 30, 0.3)) {
    whole.add(row.phi, row.y, 1.0, Likelihood::student);
    sliced.add(row.phi, row.y, 1.0, Likelihood::student);
  }
  solve(whole);
  int slices = 0;
  for (bool done = false; !done; ++slices) {
    Budget one_step(1);
    done = sliced.solve(kGroups, one_step);
  }
  EXPECT_GE(slices, static_cast<int>(kFeatures));
  EXPECT_EQ(testing::saved(whole), testing::saved(sliced));
}

// Neighbours in time say the same: errors that go on for ten rows are one sample's.
TEST(Posterior, RowsAlikeAreNoFurtherEvidence) {
  const std::vector<Row> data = rows(6, 300, 0.5);
  Posterior once(kFeatures, 4);
  Posterior repeated(kFeatures, 4);
  for (const Row& row : data) {
    learn(once, row);
    for (int i = 0; i < 10; ++i) {
      learn(repeated, row);
    }
  }
  solve(once);
  solve(repeated);
  EXPECT_GT(repeated.rows_per_sample(), 4.0 * once.rows_per_sample());
  EXPECT_GT(repeated.error(3), 0.6 * once.error(3));  // 0.32 for ten times the samples
}

TEST(Posterior, TheFirstFeaturesAloneAreAModelOfTheirOwn) {
  std::vector<Row> data = rows(7, 400, 0.1);
  const Posterior posterior = learned(data, 3);
  const std::span<const double> first = posterior.first_weights();
  ASSERT_EQ(first.size(), 3U);
  // The third feature, which they lack, is independent of them: their weights are the same.
  EXPECT_NEAR(first[2], kTruth[2], 0.3);
  EXPECT_NEAR(posterior.weights()[2], kTruth[2], 0.3);
}

// φ' = Tᵀ φ: the same function at once, and the posterior of the new features after the next solve.
TEST(Posterior, FollowsAChangeOfItsFeatures) {
  Eigen::Matrix3d map;
  map << 1.0, 0.2, 0.0, 0.0, 0.8, 0.1, -0.3, 0.0, 1.1;
  Matrix t(3, 3);  // of the features 4 to 6
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      t(i, j) = map(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  }
  const auto mapped = [&](std::vector<double> phi) {
    Eigen::Map<Eigen::Vector3d> last(phi.data() + 4);
    last = map.transpose() * Eigen::Vector3d(last);
    return phi;
  };
  const std::vector<Row> data = rows(8, 300, 0.3);
  const Posterior old = learned(data);
  Posterior moved = old;
  moved.change_features(4, t);
  Posterior anew(kFeatures, 4);
  for (const Row& row : data) {
    learn(anew, {mapped(row.phi), row.y});
  }
  for (int i = 0; i < 20; ++i) {
    EXPECT_NEAR(value(moved, mapped(data[i].phi)), value(old, data[i].phi), 1e-9);
  }
  EXPECT_TRUE(moved.wants_solve());
  solve(moved);
  solve(anew);
  for (int i = 0; i < 20; ++i) {
    EXPECT_NEAR(value(moved, mapped(data[i].phi)), value(anew, mapped(data[i].phi)), 0.02);
  }
}

// As of a vehicle with other weights: the same as if the targets had been those of that vehicle,
// at once, at the end of a solve at hand, and after the next solve.
TEST(Posterior, TellsItsSamplesAnew) {
  const std::array<double, 4> step{-2.0, 1.0, 1.5, 0.0};
  const std::vector<Row> data = rows(10, 403, 0.3);
  std::vector<Row> other = data;
  for (Row& row : other) {
    for (std::size_t i = 0; i < step.size(); ++i) {
      row.y += step[i] * row.phi[i];
    }
  }
  const Posterior direct = learned(other);
  Posterior told = learned(data);
  const auto expect_same = [&](double within) {
    for (std::size_t i = 0; i < 20; ++i) {
      EXPECT_NEAR(value(told, data[i].phi), value(direct, data[i].phi), within);
    }
    EXPECT_NEAR(told.sums().targets().mean, direct.sums().targets().mean, 0.02);
    EXPECT_NEAR(told.sums().targets().scale, direct.sums().targets().scale, 0.02);
  };
  Budget one_step(1);
  EXPECT_FALSE(told.solve(kGroups, one_step));
  told.tell_anew(step, step, kAll);
  expect_same(0.05);
  solve(told);
  expect_same(0.05);
  solve(told);
  expect_same(0.05);
  EXPECT_NEAR(told.first_weights()[1], direct.first_weights()[1], 0.3);
  EXPECT_NEAR(told.noise(), direct.noise(), 0.01);
}

TEST(Posterior, LaterSamplesCountMoreAfterEarlierFade) {
  const auto error_after = [](double kept) {
    Posterior posterior = learned(rows(11, 2000, 0.3));
    Budget one_step(1);
    EXPECT_FALSE(posterior.solve(kGroups, one_step));  // a solve is at hand
    posterior.tell_anew({}, {}, kept);
    for (Row& row : rows(12, 200, 0.3)) {
      row.y += 0.3;
      learn(posterior, row);
    }
    return std::abs(value(posterior, std::array{1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}) - 5.3);
  };
  EXPECT_LT(error_after(50.0), 0.15);
  EXPECT_GT(error_after(kAll), 0.2);
}

TEST(Posterior, GoesOnFromASavedState) {
  const std::vector<Row> data = rows(9, 250, 0.3);
  const auto make = [] { return Posterior(kFeatures, 4); };
  testing::expect_same_life(
      make, data.size(), [](std::size_t i) { return i % 13 == 5; },
      [&](Posterior& posterior, std::size_t i) {
        posterior.add(data[i].phi, data[i].y, 1.0, Likelihood::student);
        if (i % 40 == 39) {
          const std::array step{0.0, 0.1, 0.0, 0.0};
          posterior.tell_anew(step, step, 50.0);
        }
        Budget one_step(1);  // a solve is at hand at most stops
        if (posterior.wants_solve()) {
          posterior.solve(kGroups, one_step);
        }
      });
}

}  // namespace
}  // namespace kelpie::posterior_test
