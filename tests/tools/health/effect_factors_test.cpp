// SPDX-License-Identifier: Apache-2.0
#include "health/effect_factors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"

namespace kelpie::health::effect_factors_test {
namespace {

const std::vector<std::string> kNames{"u", "n"};
constexpr std::array<std::size_t, 1> kVelocity{0};
constexpr double kGapS = 1.0;

struct Truth {
  double drag = 1.0;
  double gain = 1.0;
  double force = 0.0;
  double volts = 0.0;    // fall of the supply, share
  double density = 1.0;  // of the water, over 1000 kg/m³
};

// u' = ρ (gain V² 0.01 n|n| − drag (0.3 u + 2 u|u|)) + force, ten minutes at 10 Hz, with noise.
DriveRows drive(const Truth& truth, std::uint64_t seed) {
  RandomStream random(seed, "drive");
  DriveRows rows;
  double u = 0.0;
  double phase = 0.0;
  for (int i = 0; i < 6000; ++i) {
    phase += random.uniform(0.005, 0.03);
    const double n = 10.0 * std::sin(phase) * std::cos(0.37 * phase);
    const double volts = 16.0 * (1.0 - truth.volts * i / 6000.0);
    const double supply = std::pow(volts / 16.0, 2.0);
    for (int k = 0; k < 10; ++k) {
      const double thrust = truth.gain * supply * 0.01 * n * std::abs(n);
      u += 0.01 * (truth.density * (thrust - truth.drag * (0.3 * u + 2.0 * u * std::abs(u))) +
                   truth.force);
    }
    rows.times_s.push_back(0.1 * i);
    rows.inputs.insert(rows.inputs.end(), {u + 0.005 * random.normal(), n});
    rows.volts.push_back(volts);
    rows.density.push_back(1000.0 * truth.density);
  }
  return rows;
}

TEST(EffectFactors, TellDragGainAndForceApart) {
  std::vector<DriveRows> drives;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    drives.push_back(drive({}, seed));
  }
  drives.push_back(drive({.drag = 1.1}, 7));
  drives.push_back(drive({.gain = 0.9}, 8));
  drives.push_back(drive({.force = 0.02}, 9));
  const EffectFactors found = fit_factors(drives, kNames, kVelocity, kGapS);
  ASSERT_EQ(found.effects.size(), 3U);
  EXPECT_FALSE(found.exponent);
  const auto& before = found.drives[0];
  const auto ratio = [&](std::size_t drive, std::size_t effect) {
    return found.drives[drive][effect].value / before[effect].value;
  };
  EXPECT_NEAR(ratio(6, 0), 1.1, 0.02);
  EXPECT_NEAR(ratio(6, 1), 1.0, 0.01);
  EXPECT_NEAR(ratio(7, 0), 1.0, 0.02);
  EXPECT_NEAR(ratio(7, 1), 0.9, 0.01);
  EXPECT_NEAR(found.drives[8][2].value - before[2].value, 0.02, 0.002);
  for (std::size_t i = 1; i < 6; ++i) {  // equal drives, within their errors
    for (std::size_t effect = 0; effect < 3; ++effect) {
      const EffectFactor& one = found.drives[i][effect];
      EXPECT_LT(std::abs(one.value - before[effect].value),
                4.0 * std::hypot(one.error, before[effect].error));
    }
  }
}

TEST(EffectFactors, TakeOffTheSupplyAndTheDensity) {
  std::vector<DriveRows> drives;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    drives.push_back(
        drive({.volts = 0.04 * static_cast<double>(seed), .density = seed > 3 ? 1.03 : 1.0}, seed));
  }
  const EffectFactors found = fit_factors(drives, kNames, kVelocity, kGapS);
  ASSERT_TRUE(found.exponent);
  EXPECT_NEAR(*found.exponent, 2.0, 0.25);
  EXPECT_NEAR(found.density.second, 1030.0, 1.0);
  for (const auto& factors : found.drives) {
    EXPECT_NEAR(factors[0].value / found.drives[0][0].value, 1.0, 0.015);
    EXPECT_NEAR(factors[1].value / found.drives[0][1].value, 1.0, 0.01);
  }
}

TEST(EffectFactors, SayWhatIsNotTold) {
  std::vector<DriveRows> drives{drive({}, 1), drive({}, 2)};
  DriveRows still;
  for (int i = 0; i < 6000; ++i) {
    still.times_s.push_back(0.1 * i);
    still.inputs.insert(still.inputs.end(), {0.0, 0.0});
  }
  drives.push_back(still);
  DriveRows brief = drive({}, 3);
  brief.times_s.resize(100);
  brief.inputs.resize(200);
  drives.push_back(brief);
  const EffectFactors found = fit_factors(drives, kNames, kVelocity, kGapS);
  EXPECT_TRUE(std::isnan(found.drives[2][0].value));
  EXPECT_TRUE(std::isnan(found.drives[2][1].value));
  EXPECT_TRUE(std::isnan(found.drives[3][0].value));
  EXPECT_THROW(fit_factors(std::vector{brief}, kNames, kVelocity, kGapS), InputError);
}

}  // namespace
}  // namespace kelpie::health::effect_factors_test
