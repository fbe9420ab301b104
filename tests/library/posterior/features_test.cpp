// SPDX-License-Identifier: Apache-2.0
#include "posterior/features.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"
#include "posterior/posterior.hpp"
#include "saved_state.hpp"

namespace kelpie::features_test {
namespace {

const std::vector<std::string> kInputs{"u", "v", "th1", "th2"};
constexpr std::array<std::size_t, 2> kStates{0, 1};

Features features(std::size_t centres = 30) {
  return {kInputs.size(), TermSet::from("auto", kInputs, 2), kStates, centres};
}

std::vector<double> sample(RandomStream& random, double size = 1.0) {
  return {size * random.normal(), size * random.normal(), random.uniform(-1.0, 1.0), 0.5};
}

TEST(Features, TermsAlikeShareAGroup) {
  const Features all = features();
  const auto group_of = [&](std::string_view term) {
    const std::vector<std::string> texts = all.terms().texts();
    const auto place = std::ranges::find(texts, term) - texts.begin();
    EXPECT_LT(static_cast<std::size_t>(place), texts.size()) << term;
    return all.groups()[1 + static_cast<std::size_t>(place)];
  };
  EXPECT_EQ(all.groups()[0], FeatureGroup::kFlat);
  EXPECT_EQ(group_of("u"), group_of("v"));
  EXPECT_EQ(group_of("th1"), group_of("th2"));
  EXPECT_NE(group_of("u"), group_of("th1"));
  EXPECT_NE(group_of("u*|u|"), group_of("u*v"));
  EXPECT_EQ(all.groups().back(), FeatureGroup::kKernel);
}

TEST(Features, AVelocityFarAwayCountsLittle) {
  Features all = features();
  RandomStream random(1, "features");
  for (int i = 0; i < 200; ++i) {
    const std::vector<double> x = sample(random);
    all.observe(x, all.trust(x));
  }
  EXPECT_EQ(all.trust(std::vector<double>{3.0, 0.0, 0.0, 0.5}), 1.0);
  EXPECT_LT(all.trust(std::vector<double>{1000.0, 0.0, 0.0, 0.5}), 1e-7);
  EXPECT_EQ(all.trust(std::vector<double>{0.0, 0.0, 1000.0, 0.5}), 1.0);  // a command is no state
}

// Places come from what is new, up to the room; an input that never moved says nothing.
TEST(Features, CentresAreFewAndNovel) {
  Features all = features(12);
  RandomStream random(2, "centres");
  for (int i = 0; i < 400; ++i) {
    const std::vector<double> x = sample(random);
    all.observe(x, 1.0);
    const std::span<const double> phi = all.learn(x);
    EXPECT_EQ(phi.size(), all.size());
    EXPECT_EQ(phi.front(), 1.0);
  }
  EXPECT_EQ(all.basis().size(), 12U);
  EXPECT_EQ(all.units().whitening(3, 3), 0.0);
}

// The kernel follows an input that outgrows its unit; the map of the functions has their sizes.
TEST(Features, NewUnitsComeWithAMap) {
  Features all = features();
  RandomStream random(3, "units");
  std::size_t moves = 0;
  for (int i = 0; i < 600; ++i) {
    const std::vector<double> x = sample(random, i < 300 ? 0.1 : 2.0);
    const std::size_t before = all.basis().size();
    if (const std::optional<Matrix> t = all.observe(x, all.trust(x))) {
      EXPECT_EQ(t->rows(), before);
      EXPECT_EQ(t->rows() == 0 ? 0 : t->columns(), all.basis().size());
      ++moves;
    }
    all.learn(x);
  }
  EXPECT_GE(moves, 3U);
  EXPECT_LT(moves, 20U);
  EXPECT_NEAR(all.units().whitening(0, 0), 1.0 / 1.4, 0.35);
}

TEST(Features, GoOnFromASavedState) {
  RandomStream random(4, "life");
  std::vector<std::vector<double>> rows;
  for (int i = 0; i < 150; ++i) {
    rows.push_back(sample(random, i < 75 ? 0.1 : 1.0));
  }
  testing::expect_same_life([] { return features(); }, rows.size(),
                            [](std::size_t i) { return i % 20 == 9; },
                            [&](Features& all, std::size_t i) {
                              all.observe(rows[i], all.trust(rows[i]));
                              all.learn(rows[i]);
                            });
}

}  // namespace
}  // namespace kelpie::features_test
