// SPDX-License-Identifier: Apache-2.0
#include "kelpie/learner/recursive_least_squares.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "kelpie/motion/term_set.hpp"
#include "support.hpp"

namespace kelpie::recursive_least_squares_test {
namespace {

const std::vector<std::string> kInputs{"u", "v", "r", "th1", "th2", "th3"};

std::vector<double> drive(RandomStream& random) {
  std::vector<double> x;
  for (std::size_t k = 0; k < kInputs.size(); ++k) {
    x.push_back(k < 3 ? random.uniform(-0.5, 0.5) : random.uniform(-12.0, 12.0));
  }
  return x;
}

// A plant that is linear in the terms, of the size a real vehicle's coefficients have.
double plant(const RecursiveLeastSquares& learner, const std::vector<double>& x,
             double strength = 1.0) {
  const RecursiveLeastSquares::Terms phi = learner.terms(x);
  double y = 0.0;
  for (std::size_t k = 0; k < phi.size(); ++k) {
    y += strength * (k < 10 ? -0.3 + 0.1 * static_cast<double>(k) : 0.001) * phi[k];
  }
  return y;
}

double worst_error(const RecursiveLeastSquares& learner, double strength = 1.0) {
  RandomStream random(99, "held out");
  double worst = 0.0;
  for (int i = 0; i < 200; ++i) {
    const std::vector<double> x = drive(random);
    worst = std::max(worst, std::abs(learner.predict(x) - plant(learner, x, strength)));
  }
  return worst;
}

std::vector<std::string> input_names(std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) {
    names.push_back("x" + std::to_string(i));
  }
  return names;
}

RecursiveLeastSquaresSettings with(double lambda, double huber = 0.0, double prior = 1e-12) {
  return {.velocities = 3, .lambda = lambda, .huber = huber, .prior = prior};
}

// In this order the terms stand in docs/measured/reproduction.md.
TEST(RecursiveLeastSquares, TakesPlanarMotionsTermsInTheirOrder) {
  const RecursiveLeastSquares learner(input_names(5), {});
  const RecursiveLeastSquares::Terms values = learner.terms(std::vector{2.0, -3.0, 0.5, 4.0, -5.0});
  const std::vector<double> expected{2.0,  -3.0, 0.5,  4.0,   -9.0, 0.25,  // ν, ν|ν|
                                     -6.0, 1.0,  -1.5, 0.25,               // uv, ur, vr, r²
                                     16.0, 0.0,  -0.0, -25.0, 1.0};        // thrusters, constant
  EXPECT_EQ(std::vector<double>(values.begin(), values.end()), expected);
}

TEST(RecursiveLeastSquares, TakesOtherTermsAsTheyAreGiven) {
  const std::vector<std::string> inputs{"u", "f"};
  RecursiveLeastSquares learner(2, TermSet::from("f; u*f", inputs, 1), with(1.0));
  const std::vector<std::vector<double>> samples{{1.0, 2.0}, {2.0, -1.0}, {-1.0, 1.0}};
  for (const std::vector<double>& x : samples) {
    learner.update(x, 3.0 * x[1] + 0.5 * x[0] * x[1] - 1.0, 0.0);
  }
  EXPECT_NEAR(learner.predict(std::vector{4.0, 5.0}), 15.0 + 10.0 - 1.0, 1e-6);
  EXPECT_THROW(RecursiveLeastSquares(2, TermSet::from("f", inputs, 1), with(1.1)), InputError);
}

class AgainstBatch : public ::testing::TestWithParam<double> {};

TEST_P(AgainstBatch, EqualsWeightedLeastSquares) {
  const double lambda = GetParam();
  constexpr Eigen::Index kSamples = 1200;
  RandomStream random(1, "batch");
  RecursiveLeastSquares learner(kInputs, with(lambda));
  const auto m = static_cast<Eigen::Index>(learner.estimates().size());
  Eigen::MatrixXd phi(kSamples, m);
  Eigen::VectorXd y(kSamples);
  for (Eigen::Index i = 0; i < kSamples; ++i) {
    const std::vector<double> x = drive(random);
    const double target = plant(learner, x) + 0.05 * random.normal();
    const double weight = std::pow(lambda, 0.5 * static_cast<double>(kSamples - 1 - i));
    const RecursiveLeastSquares::Terms terms = learner.terms(x);
    phi.row(i) = weight * Eigen::Map<const Eigen::RowVectorXd>(terms.data(), m);
    y(i) = weight * target;
    learner.update(x, target, static_cast<double>(i));
  }
  const Eigen::LDLT<Eigen::MatrixXd> normal(phi.transpose() * phi);
  const Eigen::VectorXd batch = normal.solve(phi.transpose() * y);
  const Eigen::VectorXd variances = normal.solve(Eigen::MatrixXd::Identity(m, m)).diagonal();
  for (Eigen::Index k = 0; k < m; ++k) {
    const auto term = static_cast<std::size_t>(k);
    EXPECT_NEAR(learner.estimates()[term], batch(k), 1e-8 * batch.cwiseAbs().maxCoeff()) << k;
    EXPECT_NEAR(learner.variances()[term], variances(k), 1e-6 * variances(k)) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(RecursiveLeastSquares, AgainstBatch, ::testing::Values(1.0, 0.995, 0.97));

TEST(RecursiveLeastSquares, RecoversAPlantThatIsLinearInItsTerms) {
  RandomStream random(2, "plant");
  RecursiveLeastSquares learner(kInputs, with(1.0));
  for (int i = 0; i < 100; ++i) {
    const std::vector<double> x = drive(random);
    learner.update(x, plant(learner, x), i);
  }
  EXPECT_LT(worst_error(learner), 1e-8);
}

TEST(RecursiveLeastSquares, ForgettingFollowsAChangedPlant) {
  RandomStream random(3, "switch");
  RecursiveLeastSquares forgetting(kInputs, with(0.98));
  RecursiveLeastSquares remembering(kInputs, with(1.0));
  for (int i = 0; i < 2000; ++i) {
    const std::vector<double> x = drive(random);
    const double y = plant(forgetting, x, i < 1000 ? 1.0 : 2.0);
    forgetting.update(x, y, i);
    remembering.update(x, y, i);
  }
  EXPECT_LT(worst_error(forgetting, 2.0), 1e-6);
  EXPECT_GT(worst_error(remembering, 2.0), 0.1);
}

// A vehicle that starts slowly: its first samples fit well, so the usual error is tiny when it
// begins to move.
TEST(RecursiveLeastSquares, WithHuberANoiselessVehicleIsStillFound) {
  const std::vector<std::string> inputs{"u", "n"};
  RecursiveLeastSquares learner(inputs, {.velocities = 1, .huber = 3.0, .prior = 0.1});
  RandomStream random(1, "drive");
  double u = 0.0;
  double phase = 0.0;
  double worst = 0.0;
  for (int i = 0; i < 2400; ++i) {
    phase += random.uniform(0.01, 0.05);
    const std::array x{u, 10.0 * std::sin(phase)};
    const double a = 0.01 * x[1] * std::abs(x[1]) - 2.0 * u * std::abs(u) - 0.3 * u;
    const Decision decision = learner.update(x, a, 0.1 * i);
    if (i >= 1200) {
      worst = std::max(worst, std::abs(a - decision.prediction.value));
    }
    u += 0.1 * a;
  }
  EXPECT_LT(worst, 0.02);  // of accelerations up to 1
}

TEST(RecursiveLeastSquares, TheHuberClipSurvivesOutliersWhereThePlainOneDoesNot) {
  RandomStream random(4, "outliers");
  RecursiveLeastSquares plain(kInputs, with(0.99));
  RecursiveLeastSquares robust(kInputs, with(0.99, 1.5));
  constexpr double kNoise = 0.05;
  double plain_error = 0.0;
  double robust_error = 0.0;
  for (int i = 0; i < 6000; ++i) {
    const std::vector<double> x = drive(random);
    const double truth = plant(plain, x);
    const double outlier = random.uniform() < 0.05 ? 8.0 : 0.0;  // all to one side
    if (i > 1000) {
      plain_error += std::pow(plain.predict(x) - truth, 2);
      robust_error += std::pow(robust.predict(x) - truth, 2);
    }
    const double y = truth + kNoise * (random.normal() + outlier);
    plain.update(x, y, i);
    robust.update(x, y, i);
  }
  EXPECT_LT(robust_error, 0.25 * plain_error);
  EXPECT_LT(std::sqrt(robust_error / 5000.0), 0.5 * kNoise);
}

TEST(RecursiveLeastSquares, AClipDoesNotKeepItFromFollowingASwitch) {
  RandomStream random(5, "clip and switch");
  RecursiveLeastSquares learner(kInputs, with(0.98, 2.0));
  for (int i = 0; i < 2000; ++i) {
    const std::vector<double> x = drive(random);
    const double y = plant(learner, x, i < 1000 ? 1.0 : 2.0) + 0.01 * random.normal();
    learner.update(x, y, i);
  }
  EXPECT_LT(worst_error(learner, 2.0), 0.05);
}

// A vehicle that lies still for hours: exponential forgetting alone would let P grow by λ⁻ⁿ and the
// first movement afterwards throw the coefficients about.
TEST(RecursiveLeastSquares, WeakExcitationNeitherBlowsUpTheCovarianceNorForgetsThePlant) {
  RandomStream random(6, "rest");
  const double lambda = 0.98;
  const double prior = 0.1;
  RecursiveLeastSquares guarded(kInputs, with(lambda, 0.0, prior));
  RecursiveLeastSquares unguarded(kInputs, with(lambda));
  constexpr int kSamples = 20'000;
  std::vector<double> moments(17);
  for (int i = 0; i < kSamples; ++i) {
    const std::vector<double> x =
        i < 1000 ? drive(random) : std::vector{0.0, 0.0, 0.0, 3.0, 3.0, 0.0};
    const double y = plant(guarded, x) + 0.01 * random.normal();
    guarded.update(x, y, i);
    unguarded.update(x, y, i);
    const RecursiveLeastSquares::Terms phi = guarded.terms(x);
    for (std::size_t k = 0; k < phi.size(); ++k) {
      moments[k] += phi[k] * phi[k] / kSamples;
    }
  }
  const std::vector<double> variances = guarded.variances();
  for (std::size_t k = 0; k < variances.size(); ++k) {
    EXPECT_LT(variances[k] * moments[k], 1.01 * std::pow(lambda, -16) / prior) << k;
  }
  EXPECT_LT(worst_error(guarded), 0.6);
  EXPECT_GT(worst_error(unguarded), 3.0);
}

TEST(RecursiveLeastSquares, UnitsOfTheInputsChangeNothing) {
  RandomStream random(7, "units");
  RecursiveLeastSquares si(kInputs, with(0.99, 2.0, 1e-4));
  RecursiveLeastSquares other(kInputs, with(0.99, 2.0, 1e-4));
  for (int i = 0; i < 500; ++i) {
    const std::vector<double> x = drive(random);
    std::vector<double> scaled = x;
    for (std::size_t k = 0; k < kInputs.size(); ++k) {
      scaled[k] *= k < 3 ? 1000.0 : 60.0;  // mm/s, 1/min
    }
    const double y = plant(si, x) + 0.1 * random.normal();
    ASSERT_NEAR(si.predict(x), other.predict(scaled), 1e-6) << i;
    si.update(x, y, i);
    other.update(scaled, y, i);
  }
}

TEST(RecursiveLeastSquares, BadSamplesAreTurnedAwayAndChangeNothing) {
  RandomStream random(8, "bad");
  RecursiveLeastSquares learner(kInputs, with(0.99));
  for (int i = 0; i < 100; ++i) {
    const std::vector<double> x = drive(random);
    learner.update(x, plant(learner, x), i);
  }
  const std::vector<double> before(learner.estimates().begin(), learner.estimates().end());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> x = drive(random);
  EXPECT_EQ(learner.update(x, nan, 0.0).verdict, Verdict::invalid);
  EXPECT_EQ(learner.update(x, 0.0, nan).verdict, Verdict::invalid);
  EXPECT_EQ(learner.update(std::span(x).first(5), 0.0, 0.0).verdict, Verdict::invalid);
  x[4] = 1e100;
  EXPECT_EQ(learner.update(x, 0.0, 0.0).verdict, Verdict::invalid);
  x[4] = nan;
  EXPECT_TRUE(std::isnan(learner.update(x, 0.0, 0.0).prediction.value));
  EXPECT_EQ(learner.status().tally.invalid, 5);
  EXPECT_TRUE(std::ranges::equal(learner.estimates(), before));
}

TEST(RecursiveLeastSquares, ATermNeverExcitedStaysOutOfTheModel) {
  RandomStream random(9, "unused thruster");
  RecursiveLeastSquares learner(kInputs, with(0.98));
  for (int i = 0; i < 500; ++i) {
    std::vector<double> x = drive(random);
    x[5] = 0.0;
    learner.update(x, plant(learner, x), i);
  }
  EXPECT_EQ(learner.estimates()[14], 0.0);
  EXPECT_TRUE(std::isinf(learner.variances()[14]));
  EXPECT_TRUE(
      std::ranges::all_of(learner.estimates(), [](double theta) { return std::isfinite(theta); }));
}

TEST(RecursiveLeastSquares, RefusesWhatMakesNoSense) {
  const auto message = [](std::size_t inputs, const RecursiveLeastSquaresSettings& settings) {
    return testing::message_of<InputError>([&] {
      const std::vector<std::string> names = input_names(inputs);
      return RecursiveLeastSquares(names, settings);
    });
  };
  EXPECT_EQ(message(2, {}),
            "inputs: 2 given; there have to be 3 velocities and up to 61 thruster speeds");
  EXPECT_EQ(message(64, {.velocities = 6}), "terms: 144 given; a model takes at most 128");
  EXPECT_EQ(message(6, with(1.1)), "lambda: 1.1 is out of range; it has to be 0.5 to 1");
}

}  // namespace
}  // namespace kelpie::recursive_least_squares_test
