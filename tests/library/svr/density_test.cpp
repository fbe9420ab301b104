// SPDX-License-Identifier: Apache-2.0
#include "svr/density.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "kelpie/core/random.hpp"

namespace kelpie::density_test {
namespace {

constexpr double kBandwidth = 0.4;
using Place = std::array<double, 2>;

struct Buffer {
  SampleStore samples{2, 400};
  KernelDensity density{2, 400, kBandwidth};

  void add(const Place& place) {
    density.add(place, samples);
    samples.push_back(place);
  }
  void remove(std::size_t i) {
    density.remove(i, samples);
    samples.remove(i);
  }
  Place at(std::size_t i) const {
    Place place{};
    samples.get(i, place);
    return place;
  }
  double novelty(const Place& place) const { return density.novelty(place, samples); }
};

Place random_place(RandomStream& random) {
  return {random.normal(), 0.3 * random.normal()};
}

// Everybody's density by the others, z being one of all.
double novelty_by_definition(const Buffer& buffer, const Place& z) {
  std::vector<Place> all{z};
  for (std::size_t i = 0; i < buffer.samples.size(); ++i) {
    all.push_back(buffer.at(i));
  }
  std::vector<double> density(all.size(), 0.0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < all.size(); ++j) {
      const double square = std::pow(all[i][0] - all[j][0], 2) + std::pow(all[i][1] - all[j][1], 2);
      density[i] += i == j ? 0.0 : std::exp(-0.5 * square / (kBandwidth * kBandwidth));
    }
  }
  double denser = 0.0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    denser += density[i] > density[0] ? 1.0 : 0.0;
  }
  return denser / static_cast<double>(all.size() - 1);
}

TEST(Novelty, IsTheRankByDefinitionWhileSamplesComeAndGo) {
  RandomStream random(1, "novelty");
  Buffer buffer;
  for (int step = 0; step < 700; ++step) {
    buffer.add(random_place(random));
    if (buffer.samples.size() > 300) {
      buffer.remove(static_cast<std::size_t>(random.uniform(0.0, 300.0)));
    }
    if (step % 50 == 49) {
      const Place z = random_place(random);
      // One place of difference at most: densities may agree but for rounding.
      EXPECT_NEAR(buffer.novelty(z), novelty_by_definition(buffer, z), 1.0 / 290.0);
    }
  }
}

TEST(Novelty, HasItsEndsWhereTheyAreExpected) {
  RandomStream random(2, "novelty");
  Buffer buffer;
  EXPECT_EQ(buffer.novelty({0.0, 0.0}), 1.0);  // nothing is known
  for (int i = 0; i < 200; ++i) {
    buffer.add(random_place(random));
  }
  EXPECT_EQ(buffer.novelty({50.0, 0.0}), 1.0);
  EXPECT_EQ(buffer.novelty({1e200, -1e200}), 1.0);
  EXPECT_LT(buffer.novelty({0.0, 0.0}), 0.1);
  double before = buffer.novelty({0.0, 0.0});
  for (int step = 1; step < 10; ++step) {
    const double away = 0.5 * step;
    EXPECT_GE(buffer.novelty({away, 0.0}) + 0.1, before);
    before = buffer.novelty({away, 0.0});
  }
}

TEST(Novelty, OfThePlaceThatAllSamplesShareIsNone) {
  Buffer buffer;
  for (int i = 0; i < 20; ++i) {
    buffer.add({0.3, -0.2});
  }
  EXPECT_EQ(buffer.novelty({0.3, -0.2}), 0.0);
  EXPECT_EQ(buffer.novelty({0.35, -0.2}), 1.0);
}

// Draws from what the samples were drawn from: 400 ranks, their mean 0.5 with standard error 0.015,
// a tenth of them above 0.9 (0.015); bounds at four standard errors.
TEST(Novelty, IsUniformForDrawsLikeTheSamples) {
  RandomStream random(3, "novelty");
  double mean = 0.0;
  double high = 0.0;
  for (int draw = 0; draw < 400; ++draw) {
    Buffer buffer;
    for (int i = 0; i < 40; ++i) {
      buffer.add(random_place(random));
    }
    const double novelty = buffer.novelty(random_place(random));
    mean += novelty / 400.0;
    high += novelty > 0.9 ? 1.0 / 400.0 : 0.0;
  }
  EXPECT_NEAR(mean, 0.5, 0.06);
  EXPECT_NEAR(high, 0.1, 0.06);
}

// Where samples lie doesn't matter, only how they lie to each other.
TEST(Novelty, DoesNotChangeWhenEverythingIsShifted) {
  RandomStream random(4, "novelty");
  Buffer here;
  Buffer there;
  for (int i = 0; i < 100; ++i) {
    const Place place = random_place(random);
    here.add(place);
    there.add({place[0] + 4.0, place[1] - 8.0});
  }
  for (int i = 0; i < 50; ++i) {
    const Place z = random_place(random);
    EXPECT_NEAR(here.novelty(z), there.novelty({z[0] + 4.0, z[1] - 8.0}), 0.011);
  }
}

}  // namespace
}  // namespace kelpie::density_test
