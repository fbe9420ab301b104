// SPDX-License-Identifier: Apache-2.0
#include "learner/disturbance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "allocation_count.hpp"
#include "kelpie/core/random.hpp"
#include "saved_state.hpp"

namespace kelpie::disturbance_test {
namespace {

constexpr double kRho = 0.9;
constexpr double kInnovation = 0.1;  // standard deviation
constexpr double kStepS = 0.25;
const double kSpread = kInnovation / std::sqrt(1.0 - kRho * kRho);

struct Sample {
  double predicted = 0.0;
  double y = 0.0;
  double t = 0.0;
};
using Samples = std::vector<Sample>;

// A model that is right but for noise of the autocorrelation rho.
Samples disturbed(std::size_t samples, double rho = kRho) {
  RandomStream random(1, "disturbed");
  Samples all;
  double missed = 0.0;
  for (std::size_t i = 0; i < samples; ++i) {
    missed = rho * missed + kInnovation * random.normal();
    const double predicted = std::sin(0.03 * static_cast<double>(i));
    all.push_back({predicted, predicted + missed, kStepS * static_cast<double>(i)});
  }
  return all;
}

// What was said of every sample just before it was observed.
std::vector<double> corrected(const Samples& samples) {
  Disturbance disturbance;
  std::vector<double> said;
  for (const Sample& sample : samples) {
    said.push_back(sample.predicted + disturbance.at(sample.predicted, sample.t));
    disturbance.observe(sample.predicted, sample.y, sample.t);
  }
  return said;
}

// Mean square from the sample `from` on.
double error_of(const std::vector<double>& said, const Samples& truth, std::size_t from = 0) {
  double sum = 0.0;
  for (std::size_t i = from; i < truth.size(); ++i) {
    sum += std::pow(said[i] - truth[i].y, 2);
  }
  return sum / static_cast<double>(truth.size() - from);
}

double error_of_model(const Samples& truth, std::size_t from = 0) {
  std::vector<double> said(truth.size());
  std::ranges::transform(truth, said.begin(), &Sample::predicted);
  return error_of(said, truth, from);
}

TEST(Disturbance, LeavesOnlyWhatNobodyCanKnow) {
  const Samples samples = disturbed(6000);
  EXPECT_NEAR(error_of(corrected(samples), samples, 500), kInnovation * kInnovation, 0.0005);
  Disturbance disturbance;
  for (const Sample& sample : samples) {
    disturbance.observe(sample.predicted, sample.y, sample.t);
  }
  EXPECT_NEAR(disturbance.autocorrelation(), kRho, 0.03);
}

TEST(Disturbance, FadesTowardsTheModelForLaterSamples) {
  const Samples samples = disturbed(20000);
  for (const std::size_t later : {2U, 4U, 8U, 30U}) {
    Disturbance disturbance;
    double sum = 0.0;
    for (std::size_t i = 0; i + later < samples.size(); ++i) {
      disturbance.observe(samples[i].predicted, samples[i].y, samples[i].t);
      const Sample& target = samples[i + later];
      const double d = disturbance.ahead(target.predicted, kStepS * static_cast<double>(later));
      sum += i < 500 ? 0.0 : std::pow(target.predicted + d - target.y, 2);
    }
    const double knowable = kSpread * kSpread * (1.0 - std::pow(kRho, 2 * later));
    EXPECT_NEAR(sum / static_cast<double>(samples.size() - 500 - later) / knowable, 1.0, 0.06)
        << later;
  }
}

TEST(Disturbance, DoesNoHarmWhereNothingLasts) {
  Samples samples = disturbed(20000, 0.0);
  EXPECT_LT(error_of(corrected(samples), samples), 1.01 * error_of_model(samples));
  RandomStream random(2, "half of them outliers");
  for (Sample& sample : samples) {
    sample.y += random.uniform(0.0, 1.0) < 0.5 ? 20.0 * random.normal() : 0.0;
  }
  EXPECT_LT(error_of(corrected(samples), samples), 1.01 * error_of_model(samples));
}

TEST(Disturbance, OneBadTargetSpoilsNothingBeyondTheNextSample) {
  const Samples samples = disturbed(3000);
  const std::vector<double> undisturbed = corrected(samples);
  for (const std::size_t bad : {0U, 3U, 9U, 40U, 1500U}) {
    for (const double size : {5.0, -1e3, 1e30, -1e300}) {
      Samples spoilt = samples;
      spoilt[bad].y = size;
      const std::vector<double> said = corrected(spoilt);
      EXPECT_LT(std::abs(said[bad + 1]), 15.0) << bad << ", " << size;
      EXPECT_LT(error_of(said, samples, bad + 2), 1.01 * error_of(undisturbed, samples, bad + 2))
          << bad << ", " << size;
    }
  }
}

TEST(Disturbance, OneAbsurdPredictionSpoilsNothingBeyondTheNextSample) {
  const Samples samples = disturbed(3000);
  const std::vector<double> undisturbed = corrected(samples);
  for (const double size : {5.0, -1e6, 1e200}) {
    Samples spoilt = samples;
    spoilt[1500].predicted = size;
    const std::vector<double> said = corrected(spoilt);
    EXPECT_LT(error_of(said, samples, 1502), 1.05 * error_of(undisturbed, samples, 1502)) << size;
    EXPECT_LT(std::abs(said[1501]), 5.0) << size;
  }
}

// A tether that begins to pull is no bad target: it stays.
TEST(Disturbance, FollowsOneThatBeginsAndStays) {
  Samples samples = disturbed(2000);
  for (std::size_t i = 1000; i < samples.size(); ++i) {
    samples[i].y += 3.0;
  }
  const std::vector<double> said = corrected(samples);
  for (std::size_t i = 1003; i < 1100; ++i) {
    EXPECT_NEAR(said[i], samples[i].y, 10.0 * kInnovation) << i;
  }
}

// After a pause it is another one, and what was learned of its kind still holds.
TEST(Disturbance, APauseMakesThePastStale) {
  Samples samples = disturbed(8000);
  double pauses = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    Sample& sample = samples[i];
    pauses += i % 50 == 0 ? 1000.0 : 0.0;
    sample.t += pauses;
    sample.y = i / 50 % 2 == 0 ? sample.y : 2.0 * sample.predicted - sample.y;
  }
  const std::vector<double> said = corrected(samples);
  double after = 0.0;
  double later = 0.0;
  for (std::size_t i = 4000; i < samples.size(); ++i) {
    if (i % 50 == 0) {
      EXPECT_NEAR(said[i], samples[i].predicted, 1e-9) << i;
    } else {
      (i % 50 == 1 ? after : later) += std::pow(said[i] - samples[i].y, 2);
    }
  }
  EXPECT_LT(after / 80.0, 1.5 * kInnovation * kInnovation);
  EXPECT_LT(later / (80.0 * 48.0), 1.05 * kInnovation * kInnovation);
}

TEST(Disturbance, TheRateDoesNotMatter) {
  const Samples samples = disturbed(500);
  const std::vector<double> said = corrected(samples);
  for (const double factor : {1.0 / 256.0, 1024.0}) {
    Samples other = samples;
    std::ranges::for_each(other, [factor](Sample& sample) { sample.t *= factor; });
    EXPECT_EQ(corrected(other), said) << factor;
  }
}

// Neither are its weights lost at rest, nor do they grow without bound there.
TEST(Disturbance, RestIsNoExcitation) {
  Samples samples = disturbed(2000);
  RandomStream random(3, "rest");
  const std::size_t moved = samples.size();
  const auto add = [&](double predicted, double y) {
    samples.push_back({predicted, y, samples.back().t + kStepS});
  };
  for (int i = 0; i < 50'000; ++i) {
    add(0.0, i % 2 == 0 ? 0.0 : 1e-7 * random.normal());
  }
  const std::size_t moves = samples.size();
  for (std::size_t i = 0; i < moved; ++i) {
    add(samples[i].predicted, samples[i].y);
  }
  const std::vector<double> said = corrected(samples);
  EXPECT_LT(error_of(said, samples, moves), 1.1 * kInnovation * kInnovation);
  for (std::size_t i = moved + 300; i < moves; ++i) {
    ASSERT_NEAR(said[i], 0.0, 1e-5) << i;
  }
}

// Where nothing ever differed, everything is new.
TEST(Disturbance, AVehicleThatStoodStillIsBelievedWhenItMoves) {
  Samples samples(1000);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].t = kStepS * static_cast<double>(i);
  }
  const double start_s = samples.back().t + kStepS;
  for (const Sample& sample : disturbed(1000)) {
    samples.push_back({sample.predicted, sample.y, start_s + sample.t});
  }
  const std::vector<double> said = corrected(samples);
  EXPECT_LT(error_of(said, samples, 1000), 1.3 * kInnovation * kInnovation);
  EXPECT_LT(error_of(said, samples, 1300), 1.05 * kInnovation * kInnovation);
}

TEST(Disturbance, SaysNothingBeforeItKnowsAnything) {
  const Disturbance disturbance;
  EXPECT_EQ(disturbance.next(3.0), 0.0);
  EXPECT_EQ(disturbance.ahead(3.0, 100.0), 0.0);
  EXPECT_EQ(disturbance.autocorrelation(), 0.0);
}

TEST(Disturbance, SavedAndLoadedItGoesOnToTheLastBit) {
  Samples samples = disturbed(600);
  samples[299].y = 50.0;  // so that one is suspect when it is saved
  testing::expect_same_life([] { return Disturbance(); }, samples.size(),
                            [](std::size_t i) { return i == 0 || i == 5 || i == 300; },
                            [&](Disturbance& disturbance, std::size_t i) {
                              disturbance.observe(samples[i].predicted, samples[i].y, samples[i].t);
                            });
}

TEST(Disturbance, AllocatesNothing) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  const Samples samples = disturbed(600);
  const std::size_t before = testing::allocations;
  Disturbance disturbance;
  double sum = 0.0;
  for (const Sample& sample : samples) {
    sum += disturbance.at(sample.predicted, sample.t) + disturbance.ahead(sample.predicted, 3.0);
    disturbance.observe(sample.predicted, sample.y, sample.t);
  }
  EXPECT_EQ(testing::allocations, before);
  EXPECT_TRUE(std::isfinite(sum));
}

}  // namespace
}  // namespace kelpie::disturbance_test
