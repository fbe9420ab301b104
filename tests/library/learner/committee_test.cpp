// SPDX-License-Identifier: Apache-2.0
#include "learner/committee.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "allocation_count.hpp"
#include "learner/sparse_regression.hpp"
#include "learner/streams.hpp"
#include "saved_state.hpp"

namespace kelpie::committee_test {
namespace {

using testing::r_squared_on;
using testing::Sample;
using testing::settings_for_plants;
using testing::wandering_stream;

// The samples of a wandering stream, each with three terms.
std::vector<Sample> with_terms(std::vector<Sample> stream) {
  for (Sample& sample : stream) {
    const double a = sample.z[0];
    const double b = sample.z[1];
    sample.z.insert(sample.z.end(), {a, b, b * std::abs(b)});
  }
  return stream;
}

Committee make(bool alone = false) {
  OnlineSvrSettings settings = settings_for_plants();
  settings.lambda = 0.5;
  return {2, 3, settings, {.alone = alone, .line = 3}};
}

void show(Committee& committee, const std::vector<Sample>& stream) {
  for (const Sample& sample : stream) {
    committee.update(sample.z, sample.y, sample.t);
  }
}

double share_of(const Committee& committee, const std::string& name) {
  for (const MemberShare& member : committee.members()) {
    if (member.name == name) {
      return member.share;
    }
  }
  return std::nan("");
}

TEST(Committee, AloneTheLearnerIsWhatItIsByItself) {
  Committee committee = make(true);
  OnlineSvrSettings settings = settings_for_plants();
  settings.lambda = 0.5;
  AdaptiveSvr alone(2, settings, 3);
  for (const Sample& sample : with_terms(wandering_stream(1, 600))) {
    const Decision a = committee.update(sample.z, sample.y, sample.t);
    const Decision b = alone.update(sample.z, sample.y, sample.t);
    ASSERT_EQ(a.prediction.value, b.prediction.value);
    ASSERT_EQ(committee.predict(sample.z), alone.predict(sample.z));
  }
  EXPECT_TRUE(committee.members().empty());
}

TEST(Committee, LearnsAVehicleAndAnotherOneAfterIt) {
  Committee committee = make();
  show(committee, with_terms(wandering_stream(1, 1000)));
  EXPECT_GT(r_squared_on(committee, with_terms(wandering_stream(2, 400))), 0.98);
  show(committee, with_terms(wandering_stream(3, 1000, 0.02, 2, 250.0)));
  EXPECT_EQ(committee.status().tally.changes, 1);
  EXPECT_GT(r_squared_on(committee, with_terms(wandering_stream(4, 400, 0.02, 2))), 0.97);
}

// Another vehicle that is like the one before: what was known of it is of use.
TEST(Committee, KnowsAVehicleThatIsLikeTheOneBeforeAfterFewSamples) {
  Committee committee = make();
  show(committee, with_terms(wandering_stream(21, 1500)));
  std::vector<Sample> changed = with_terms(wandering_stream(22, 150, 0.02, 0, 375.0));
  std::vector<Sample> others = with_terms(wandering_stream(23, 400));
  for (std::vector<Sample>* const stream : {&changed, &others}) {
    for (Sample& sample : *stream) {
      sample.y += 1.0;  // a tether pulls
    }
  }
  show(committee, changed);
  EXPECT_EQ(committee.status().tally.changes, 1);
  Committee fresh = make();
  show(fresh, changed);
  EXPECT_GT(r_squared_on(committee, others), 0.9);
  EXPECT_GT(r_squared_on(committee, others), r_squared_on(fresh, others));
}

// Targets that nothing explains: whoever says the mean is right, and nobody says much else.
TEST(Committee, WhereNothingCanBeKnownNothingIsSaid) {
  Committee committee = make();
  RandomStream random(5, "noise");
  std::vector<Sample> stream = with_terms(wandering_stream(6, 2000));
  for (Sample& sample : stream) {
    sample.y = random.normal();
  }
  show(committee, stream);
  EXPECT_GT(share_of(committee, "mean"), share_of(committee, "learner"));
  EXPECT_GT(share_of(committee, "mean"), share_of(committee, "precise"));
  std::vector<Sample> others = with_terms(wandering_stream(7, 2000));
  for (Sample& sample : others) {
    sample.y = random.normal();
  }
  EXPECT_GT(r_squared_on(committee, others), -0.03);
}

// Many commands, whose products count: a kernel in so many dimensions knows only places seen.
TEST(Committee, WhatIsLinearInItsTermsIsLearnedAsLeastSquaresDo) {
  constexpr std::size_t kInputs = 12;
  constexpr std::size_t kTerms = kInputs * (kInputs + 1) / 2;
  RandomStream random(31, "products");
  std::vector<double> weights(kTerms);
  std::ranges::generate(weights, [&] { return 0.15 * random.normal(); });
  const auto drive = [&](std::size_t samples) {
    std::vector<Sample> stream;
    std::vector<double> z(kInputs);
    for (std::size_t i = 0; i < samples; ++i) {
      Sample sample{.z = {}, .y = 0.1 * random.normal(), .t = 0.05 * static_cast<double>(i)};
      for (double& value : z) {
        value = 0.98 * value + 0.2 * random.normal();
      }
      sample.z = z;
      for (std::size_t a = 0; a < kInputs; ++a) {
        for (std::size_t b = a; b < kInputs; ++b) {
          sample.y += weights[sample.z.size() - kInputs] * z[a] * z[b];
          sample.z.push_back(z[a] * z[b]);
        }
      }
      stream.push_back(sample);
    }
    return stream;
  };
  OnlineSvrSettings settings = settings_for_plants();
  settings.lambda = 0.5;
  Committee committee(kInputs, kTerms, settings, {.alone = false, .line = kInputs});
  SparseRegression least_squares(kInputs, kTerms, {.terms = kTerms, .term_prior = 0.02});
  for (const Sample& sample : drive(1500)) {
    committee.update(sample.z, sample.y, sample.t);
    least_squares.update(sample.z, sample.y);
  }
  double error = 0.0;
  double of_least_squares = 0.0;
  for (const Sample& sample : drive(1500)) {
    error += std::abs(sample.y - committee.predict(sample.z));
    of_least_squares += std::abs(sample.y - least_squares.model()(sample.z));
  }
  EXPECT_LT(error, 1.1 * of_least_squares);
}

TEST(Committee, WhatItSaysStaysWithinTheTargetsSeen) {
  Committee committee = make();
  show(committee, with_terms(wandering_stream(7, 500)));
  for (const double far : {-1e6, -30.0, 30.0, 1e6}) {
    EXPECT_LT(std::abs(committee.predict(std::vector{far, far, far, far, far * std::abs(far)})),
              3.0);
  }
}

TEST(Committee, ItsCopySaysTheSameToTheLastBit) {
  Committee committee = make();
  show(committee, with_terms(wandering_stream(8, 500)));
  const FunctionMix copy = committee.function_mix();
  EXPECT_EQ(copy.members.size(), 6U);
  for (const Sample& sample : with_terms(wandering_stream(9, 100))) {
    ASSERT_EQ(copy(sample.z), committee.predict(sample.z));
    std::array<double, 5> gradient{};
    std::array<double, 5> of_copy{};
    ASSERT_EQ(copy.with_gradient(sample.z, of_copy), committee.with_gradient(sample.z, gradient));
    ASSERT_EQ(of_copy, gradient);
  }
}

TEST(Committee, SavedAndLoadedItGoesOnToTheLastBit) {
  const std::vector<Sample> first = with_terms(wandering_stream(10, 400));
  std::vector<Sample> stream = with_terms(wandering_stream(11, 400, 0.02, 2, 100.0));
  stream.insert(stream.begin(), first.begin(), first.end());
  const Committee whole = testing::expect_same_life(
      [] { return make(); }, stream.size(), [](std::size_t i) { return i % 37 == 5; },
      [&](Committee& committee, std::size_t i) {
        committee.update(stream[i].z, stream[i].y, stream[i].t);
      });
  EXPECT_EQ(whole.status().tally.changes, 1);
}

TEST(Committee, GoesOverToAnotherScaleWithWhatTheLearnerKnows) {
  Committee committee = make();
  show(committee, with_terms(wandering_stream(11, 800)));
  const std::vector<Sample> others = with_terms(wandering_stream(12, 300));
  const double before = r_squared_on(committee, others);
  const SampleMap halved = [](std::span<double> z, double& y) {
    for (double& value : z) {
      value *= 0.5;
    }
    y *= 0.5;
  };
  while (committee.rescale(halved) != RescaleStatus::switched) {
    EXPECT_NEAR(r_squared_on(committee, others), before, 1e-3);  // the one before is in service
  }
  std::vector<Sample> scaled = others;
  for (Sample& sample : scaled) {
    for (double& value : sample.z) {
      value *= 0.5;
    }
    sample.y *= 0.5;
  }
  EXPECT_GT(r_squared_on(committee, scaled), before - 0.02);
}

TEST(Committee, AsksForNoMemoryAfterItWasMade) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  const std::size_t before = testing::allocated_bytes;
  Committee committee = make();
  const auto known = static_cast<double>(Committee::bytes(
      2, 3, committee.learner().champion().settings(), {.alone = false, .line = 3}));
  EXPECT_LE(static_cast<double>(testing::allocated_bytes - before), 1.01 * known);
  const std::vector<Sample> first = with_terms(wandering_stream(13, 700));
  const std::vector<Sample> second = with_terms(wandering_stream(14, 700, 0.02, 2, 175.0));
  const std::size_t calls = testing::allocations;
  show(committee, first);
  show(committee, second);
  EXPECT_EQ(testing::allocations, calls);
  EXPECT_EQ(committee.status().tally.changes, 1);
}

}  // namespace
}  // namespace kelpie::committee_test
