// SPDX-License-Identifier: Apache-2.0
#include "health/glide_fit.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"

namespace kelpie::health::glide_fit_test {
namespace {

constexpr GlideParameters kTruth{30.0, 0.2, 0.0, 650.0, 0.008, 18.0};
constexpr std::array<std::size_t, 5> kFree{GlidePlace::buoyancy, GlidePlace::depth,
                                           GlidePlace::drag, GlidePlace::attack, GlidePlace::lag};

// Dives to 200 m with angles and ballasts that differ, a row every 15 s, by the model with noise.
GlideRows dives(const GlideParameters& truth, std::uint64_t seed, int count = 8) {
  RandomStream random(seed, "glide");
  GlideRows rows;
  double depth = 10.0;
  double t = 0.0;
  for (int dive = 0; dive < count; ++dive) {
    for (const double way : {-1.0, 1.0}) {
      const double pitch = way * random.uniform(0.3, 0.6);
      const double ballast = way * random.uniform(150.0, 350.0);
      for (int i = 0; i < 80; ++i, t += 15.0) {
        depth = std::max(5.0, depth - way * 2.0);
        rows.times_s.push_back(t);
        rows.pitch_rad.push_back(pitch + 0.02 * random.normal());
        rows.ballast_ml.push_back(ballast);
        rows.depth_m.push_back(depth);
      }
    }
  }
  const GlideMotion motion = glide(rows, truth);
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    rows.sinking.push_back(motion.sinking[i] + 0.005 * random.normal());
  }
  return rows;
}

TEST(GlideFit, FindsTheGliderThatMadeTheRows) {
  int inside = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const GlideFit fit = fit_glide(std::array{dives(kTruth, seed)}, first_glide(), kFree);
    for (const std::size_t place : kFree) {
      EXPECT_NEAR(fit.parameters[place], kTruth[place], 5.0 * fit.errors[place]) << place;
      inside += std::abs(fit.parameters[place] - kTruth[place]) < 1.645 * fit.errors[place] ? 1 : 0;
    }
    EXPECT_LT(fit.errors[GlidePlace::drag], 0.03 * kTruth[GlidePlace::drag]);
    EXPECT_EQ(fit.errors[GlidePlace::density], 0.0);
  }
  EXPECT_GE(inside, 37);
}

TEST(GlideFit, GlidesSteadilyAndFloatsAtTheSurface) {
  GlideRows rows;
  for (int i = 0; i < 40; ++i) {
    rows.times_s.push_back(20.0 * i);
    rows.pitch_rad.push_back(i < 20 ? -0.5 : 0.5);
    rows.ballast_ml.push_back(i < 20 ? -200.0 : 200.0);
    rows.depth_m.push_back(i < 30 ? 100.0 : 0.0);
  }
  const GlideParameters parameters = first_glide();
  const GlideMotion motion = glide(rows, parameters);
  EXPECT_GT(motion.sinking[15], 0.1);
  EXPECT_NEAR(motion.sinking[15], -motion.sinking[29], 1e-3);
  EXPECT_NEAR(motion.speed[15], motion.speed[29], 1e-3);
  EXPECT_EQ(motion.sinking[39], 0.0);
  // Twice the buoyancy: √2 of the speed.
  for (double& ballast : rows.ballast_ml) {
    ballast *= 2.0;
  }
  EXPECT_NEAR(glide(rows, parameters).speed[15] / motion.speed[15], std::sqrt(2.0), 1e-9);
}

TEST(GlideFit, RefusesTooFewSpeeds) {
  GlideRows rows = dives(kTruth, 1, 1);
  std::fill(rows.sinking.begin() + 40, rows.sinking.end(), NAN);
  EXPECT_THROW(fit_glide(std::array{rows}, first_glide(), kFree), InputError);
}

}  // namespace
}  // namespace kelpie::health::glide_fit_test
