// SPDX-License-Identifier: Apache-2.0
#include "learner/sparse_regression.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>
#include <vector>

#include "kelpie/core/random.hpp"
#include "saved_state.hpp"

namespace kelpie::sparse_regression_test {
namespace {

// Samples of two inputs and one term, x|x| of the first.
std::vector<double> sample(RandomStream& random, double size = 1.0) {
  const double a = size * random.normal();
  const double b = size * random.normal();
  return {a, b, a * std::abs(a)};
}

double truth(const std::vector<double>& z) {
  return std::sin(z[0]) * std::cos(0.7 * z[1]) + 0.3 * z[2] - 0.2;
}

double error_on_others(const SparseRegression& memory, std::uint64_t seed) {
  RandomStream random(seed, "others");
  double sum = 0.0;
  for (int i = 0; i < 500; ++i) {
    const std::vector<double> z = sample(random);
    sum += std::abs(memory.model()(z) - truth(z));
  }
  return sum / 500.0;
}

const SparseRegressionSettings kWithKernel{.terms = 1, .most_centres = 60};

TEST(SparseRegression, LearnsWhatALineCannotSay) {
  RandomStream random(1, "memory");
  SparseRegression memory(2, 1, kWithKernel);
  SparseRegression line(2, 1, {.terms = 1});
  for (int i = 0; i < 3000; ++i) {
    const std::vector<double> z = sample(random);
    const double y = truth(z) + 0.1 * random.normal();
    memory.update(z, y);
    line.update(z, y);
  }
  EXPECT_LT(error_on_others(memory, 2), 0.05);
  EXPECT_GT(error_on_others(line, 2), 0.3);
  EXPECT_LE(memory.centres(), 60U);
}

// φ' = 3 φ and y' = 0.4 y + 0.7: the function is the same in the new scale, and so is all that is
// learned later, as if every sample had come in that scale.
TEST(SparseRegression, ALinearOneForgetsNothingInAnotherScale) {
  constexpr double kFactor = 3.0;
  constexpr double kGain = 0.4;
  for (const double offset : {0.0, 0.7}) {
    RandomStream random(5, "scale");
    SparseRegression moved(2, 1, {.terms = 1});
    SparseRegression from_start(2, 1, {.terms = 1});
    const auto learn = [&](int samples, bool rescaled) {
      for (int i = 0; i < samples; ++i) {
        std::vector<double> z = sample(random);
        const double y = 0.3 * z[2] - 0.2 + 0.01 * random.normal();
        std::vector<double> other = z;
        other[2] *= kFactor;
        from_start.update(other, kGain * y + offset);
        rescaled ? moved.update(other, kGain * y + offset) : moved.update(z, y);
      }
    };
    learn(25, false);  // the usual error is not known yet
    const std::vector<double> z = sample(random);
    const double before = moved.model()(z);
    moved.rescale(std::vector{kFactor}, kGain, offset);
    const std::vector<double> in_new_scale{z[0], z[1], kFactor * z[2]};
    EXPECT_NEAR(moved.model()(in_new_scale), kGain * before + offset, 1e-12);
    learn(500, true);
    if (offset == 0.0) {
      EXPECT_NEAR(moved.term_error(0) / from_start.term_error(0), 1.0, 0.05);
    }
    // The prior pulls to 0 in either scale.
    EXPECT_NEAR(moved.model()(in_new_scale), from_start.model()(in_new_scale),
                offset == 0.0 ? 2e-4 : 2e-3);
  }
}

// In exact arithmetic: kernel ridge regression on the centres, with terms of a weak prior.
TEST(SparseRegression, IsRidgeRegressionOverAllSamplesWhereNoneIsOff) {
  RandomStream random(3, "memory");
  SparseRegression memory(2, 0, {.most_centres = 40});
  std::vector<std::vector<double>> z;
  std::vector<double> y;
  for (int i = 0; i < 400; ++i) {
    const std::vector<double> x = sample(random);
    z.push_back({x[0], x[1]});
    y.push_back(std::sin(x[0]) + 0.05 * std::cos(7.0 * x[1]));
    memory.update(z.back(), y.back());
  }
  const SvrFunction& model = memory.model();
  const SampleStore& centres = model.support_vectors();
  const auto count = static_cast<Eigen::Index>(centres.size());
  const auto kappa = [&](const std::vector<double>& at, Eigen::Index j) {
    const auto k = static_cast<std::size_t>(j);
    const double a = at[0] - centres.coordinate(0)[k];
    const double b = at[1] - centres.coordinate(1)[k];
    return std::exp(-model.kernel().local().gamma() * (a * a + b * b));
  };
  // The derivative by every β of Σ (y − f)² + ridge βᵀKβ is 0 at the optimum.
  Eigen::MatrixXd gram(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    for (Eigen::Index j = 0; j < count; ++j) {
      gram(i, j) = kappa({centres.coordinate(0)[at], centres.coordinate(1)[at]}, j);
    }
  }
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(count);
  double size = 0.0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      slope(j) += (y[i] - model(z[i])) * kappa(z[i], j);
      size += std::abs(y[i] * kappa(z[i], j));
    }
  }
  const Eigen::Map<const Eigen::VectorXd> beta(model.beta().data(), count);
  const Eigen::VectorXd penalty = gram * beta;
  // The penalty that balances the slope is `ridge` times K β, and little besides.
  const double ridge = slope.dot(penalty) / penalty.squaredNorm();
  EXPECT_GT(ridge, 0.0);
  EXPECT_LT((slope - ridge * penalty).norm(), 0.02 * size / std::sqrt(double(count)));
}

// Mean square error of the weights of three terms of size 1 that go together (correlation 0.99),
// after 100 samples.
double error_of_weights(double noise) {
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    RandomStream random(seed, "collinear");
    const Eigen::Vector3d weights(random.normal(), random.normal(), random.normal());
    SparseRegression line(1, 3, {.terms = 3, .prior_by_noise = true});
    for (int i = 0; i < 100; ++i) {
      const double common = random.normal();
      std::vector<double> z{0.0};
      double y = noise * random.normal();
      for (Eigen::Index k = 0; k < 3; ++k) {
        z.push_back(0.995 * common + 0.1 * random.normal());
        y += weights[k] * z.back();
      }
      line.update(z, y);
    }
    const Eigen::Map<const Eigen::Vector3d> learned(line.model().term_weights().data());
    sum += (learned - weights).squaredNorm() / 3.0;
  }
  return sum / 40.0;
}

// A prior of one sample, whatever the noise, has an error of 0.17 with little noise; least squares
// have 0.67 with much.
TEST(SparseRegression, TermsThatGoTogetherAreTheSamplesWithLittleNoiseAndThePriorsWithMuch) {
  EXPECT_LT(error_of_weights(0.01), 1e-3);
  EXPECT_LT(error_of_weights(1.0), 0.45);
}

TEST(SparseRegression, OutliersCountLittle) {
  RandomStream random(4, "memory");
  SparseRegression clean(2, 1, kWithKernel);
  SparseRegression struck(2, 1, kWithKernel);
  for (int i = 0; i < 3000; ++i) {
    const std::vector<double> z = sample(random);
    const double y = truth(z) + 0.1 * random.normal();
    clean.update(z, y);
    struck.update(z, i % 20 == 19 ? y + 30.0 : y);
  }
  EXPECT_LT(error_on_others(struck, 5), 2.0 * error_on_others(clean, 5) + 0.03);
}

// What was learned at one place stays learned, however long the vehicle is elsewhere.
TEST(SparseRegression, ForgetsNothing) {
  RandomStream random(6, "memory");
  SparseRegression memory(2, 1, kWithKernel);
  for (int i = 0; i < 1000; ++i) {
    const std::vector<double> z = sample(random);
    memory.update(z, truth(z));
  }
  const double before = error_on_others(memory, 7);
  for (int i = 0; i < 20'000; ++i) {
    std::vector<double> z = sample(random, 0.01);
    memory.update(z, truth(z));
  }
  EXPECT_LT(error_on_others(memory, 7), 2.0 * before + 0.02);
}

TEST(SparseRegression, TellsHowWellItKnowsATerm) {
  RandomStream random(8, "memory");
  SparseRegression line(2, 1, {.terms = 1});
  std::vector<double> z;
  for (int i = 0; i < 1000; ++i) {
    z = sample(random);
    line.update(z, 0.5 * z[2] + 0.2 * random.normal());
  }
  // σ / √(Σ φ²), E φ² = 3
  EXPECT_NEAR(line.term_error(0), 0.2 / std::sqrt(3000.0), 0.001);
  EXPECT_NEAR(line.model().term_weights()[0], 0.5, 4.0 * line.term_error(0));
}

// In noise that lasts rows tell less: 90 % intervals hold the truth in 80 to 98 % of 200 runs.
TEST(SparseRegression, ErrorsOfTermsHoldInNoiseThatLasts) {
  int inside = 0;
  constexpr int kRuns = 200;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    RandomStream random(seed, "coverage");
    SparseRegression line(0, 1, {.terms = 1});
    double input = 0.0;
    double noise = 0.0;
    for (int i = 0; i < 1000; ++i) {
      input = 0.99 * input + std::sqrt(1.0 - 0.99 * 0.99) * random.normal();
      noise = 0.8 * noise + 0.6 * random.normal();
      const std::vector<double> z{input};
      line.update(z, 0.5 * input + noise);
    }
    const double error = std::abs(line.model().term_weights()[0] - 0.5);
    inside += error < 1.645 * line.term_error(0) ? 1 : 0;
  }
  EXPECT_GE(inside, kRuns * 80 / 100);
  EXPECT_LE(inside, kRuns * 98 / 100);
}

// Of a second change a few rows later as of the first, not less: about 300 samples are kept.
TEST(SparseRegression, DoubtedTwiceItKnowsTermsAsWellAsDoubtedOnce) {
  RandomStream random(12, "memory");
  SparseRegression line(2, 1, {.terms = 1});
  const auto learn = [&](int samples) {
    for (int i = 0; i < samples; ++i) {
      const std::vector<double> z = sample(random);
      line.update(z, 0.5 * z[2] + 0.2 * random.normal());
    }
  };
  learn(20'000);
  line.doubt_terms(300.0);
  const double once = line.term_error(0);
  learn(100);
  line.doubt_terms(300.0);
  EXPECT_NEAR(line.term_error(0), once, 0.15 * once);
}

// A prior by the noise depends on more than the rows.
TEST(SparseRegression, SavedAfterADoubtItSaysTheSame) {
  RandomStream random(17, "memory");
  SparseRegression line(2, 1, {.terms = 1, .prior_by_noise = true});
  for (int i = 0; i < 2000; ++i) {
    const std::vector<double> z = sample(random);
    line.update(z, truth(z) + 0.2 * random.normal());
  }
  line.doubt_terms(2.0);
  line.forget_usual_error();
  SparseRegression loaded(2, 1, {.terms = 1, .prior_by_noise = true});
  testing::load(loaded, testing::saved(line));
  const std::vector<double> z = sample(random);
  EXPECT_EQ(loaded.model()(z), line.model()(z));
}

// Errors of rows that go together go together in any scale.
TEST(SparseRegression, WithKernelsItKnowsTheCorrelationOfErrorsInAnotherScale) {
  constexpr double kGain = 100.0;
  RandomStream random(13, "memory");
  SparseRegression moved(2, 1, kWithKernel);
  SparseRegression from_start(2, 1, kWithKernel);
  double noise = 0.0;
  const auto learn = [&](int samples, double gain) {
    for (int i = 0; i < samples; ++i) {
      const std::vector<double> z = sample(random);
      noise = 0.95 * noise + 0.1 * random.normal();
      moved.update(z, gain * (truth(z) + noise));
      from_start.update(z, kGain * (truth(z) + noise));
    }
  };
  learn(1000, 1.0);
  moved.rescale(std::vector{1.0}, kGain, 0.0);
  from_start.clear();
  learn(500, kGain);
  EXPECT_NEAR(moved.term_error(0) / from_start.term_error(0), 1.0, 1e-6);
}

TEST(SparseRegression, ClearedItLearnsAsIfItWereNew) {
  RandomStream random(9, "memory");
  SparseRegression used(2, 1, kWithKernel);
  for (int i = 0; i < 300; ++i) {
    used.update(sample(random), random.normal());
  }
  used.clear();
  SparseRegression fresh(2, 1, kWithKernel);
  for (int i = 0; i < 300; ++i) {
    const std::vector<double> z = sample(random);
    used.update(z, truth(z));
    fresh.update(z, truth(z));
  }
  const std::vector<double> z = sample(random);
  EXPECT_EQ(used.model()(z), fresh.model()(z));
}

// Of a vehicle that is like one known before a few samples tell much: here they say that all is as
// before but for a constant.
TEST(SparseRegression, LoosenedItExpectsWhatItKnew) {
  RandomStream random(31, "memory");
  SparseRegression known(2, 1, kWithKernel);
  for (int i = 0; i < 1000; ++i) {
    const std::vector<double> z = sample(random);
    known.update(z, truth(z) - 0.5);
  }
  std::vector<double> z = sample(random);
  const double said = known.model()(z);
  known.weaken();
  EXPECT_NEAR(known.model()(z), said, 1e-9);
  SparseRegression fresh(2, 1, kWithKernel);
  for (int i = 0; i < 20; ++i) {
    z = sample(random);
    known.update(z, truth(z));
    fresh.update(z, truth(z));
  }
  EXPECT_LT(error_on_others(known, 32), 0.1);
  EXPECT_GT(error_on_others(fresh, 32), 2.0 * error_on_others(known, 32));
  for (int i = 0; i < 2000; ++i) {  // and it gives way to many that say otherwise
    z = sample(random);
    known.update(z, -truth(z));
    fresh.update(z, -truth(z));
  }
  EXPECT_NEAR(known.model()(z), fresh.model()(z), 0.1);
}

// The first samples of all are believed, since nobody knows what is usual; shown once more they
// are told apart.
TEST(SparseRegression, StartedOverItKnowsOutliersFromTheFirstSampleOn) {
  RandomStream random(33, "memory");
  std::vector<std::pair<std::vector<double>, double>> samples;
  for (int i = 0; i < 150; ++i) {
    const std::vector<double> z = sample(random);
    samples.emplace_back(z, i % 10 == 3 ? 20.0 : truth(z));
  }
  SparseRegression memory(2, 1, kWithKernel);
  const auto show = [&] {
    for (const auto& [z, y] : samples) {
      memory.update(z, y);
    }
  };
  show();
  const double once = error_on_others(memory, 34);
  memory.start_over();
  show();
  EXPECT_LT(error_on_others(memory, 34), 0.5 * once);
}

// As of a file whose member was something else: another kernel, more centres than there is room.
TEST(SparseRegression, SaysNearlyWhatAFunctionOfAnotherKindSays) {
  RandomStream random(21, "memory");
  SparseRegression other(2, 1, {.terms = 1, .most_centres = 90, .gamma = 0.3, .new_place = 0.03});
  for (int i = 0; i < 2000; ++i) {
    const std::vector<double> z = sample(random);
    other.update(z, truth(z) + 0.05 * random.normal());
  }
  SampleStore places(3, 900);
  for (int i = 0; i < 900; ++i) {
    places.push_back(sample(random));
  }
  SparseRegression memory(2, 1, kWithKernel);
  memory.imitate(other.model(), places);
  EXPECT_LE(memory.centres(), 60U);
  EXPECT_LT(error_on_others(memory, 22), 0.06);
}

}  // namespace
}  // namespace kelpie::sparse_regression_test
