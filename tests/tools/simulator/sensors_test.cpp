// SPDX-License-Identifier: Apache-2.0
#include "simulator/sensors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "kelpie/core/error.hpp"

namespace kelpie::sensors_test {
namespace {

struct Spread {
  Eigen::Vector3d mean, deviation;
};

Spread errors(const std::string& preset, const Eigen::Vector3d& velocity, std::uint64_t seed) {
  simulator::VelocitySensors sensors(simulator::noise_preset(preset), seed);
  constexpr int kCount = 4000;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Vector3d error = sensors.measure(velocity) - velocity;
    sum += error;
    squares += error.cwiseAbs2();
  }
  const Eigen::Vector3d mean = sum / kCount;
  return {mean, (squares / kCount - mean.cwiseAbs2()).cwiseSqrt()};
}

TEST(Sensors, NoneMeansExact) {
  simulator::VelocitySensors sensors(simulator::noise_preset("none"), 1);
  const Eigen::Vector3d velocity(0.3, -0.1, 0.5);
  EXPECT_EQ(sensors.measure(velocity), velocity);
}

TEST(Sensors, PresetsHaveTheirDeviations) {
  const Eigen::Vector3d velocity(0.3, -0.1, 0.5);
  const Spread recorded = errors("as_recorded", velocity, 1);
  EXPECT_TRUE(recorded.deviation.isApprox(Eigen::Vector3d(0.0005, 0.0005, 0.00036), 0.05));
  EXPECT_LT(recorded.mean.norm(), 5e-5);
  const Spread stress = errors("stress", velocity, 1);
  EXPECT_TRUE(stress.deviation.head<2>().isApprox(Eigen::Vector2d(0.026, 0.026), 0.05));
}

TEST(Sensors, AFaultComesOnTopAndAFrozenSensorShowsWhatItShowed) {
  simulator::VelocitySensors sensors(simulator::noise_preset("none"), 1);
  const Eigen::Vector3d velocity(0.3, -0.1, 0.5);
  sensors.measure(velocity);
  sensors.set_fault({.scale = {2.0, 1.0, 1.0}, .bias = {0.0, 0.1, 0.0}, .frozen = {0, 0, 1}});
  EXPECT_TRUE(sensors.measure(2.0 * velocity).isApprox(Eigen::Vector3d(1.2, -0.1, 0.5)));
}

// Scale and bias are the instrument's own: constant within a run, another in every run.
TEST(Sensors, RawDvlHasScaleAndBiasWithinItsSpecification) {
  double greatest = 0.0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Spread spread = errors("raw_dvl", {0.5, 0.0, 0.0}, seed);
    for (const Eigen::Index axis : {0, 1}) {
      EXPECT_GT(spread.deviation(axis), 0.0019);
      EXPECT_LT(spread.deviation(axis), 0.0052);
    }
    EXPECT_LT(std::abs(spread.mean(0)), 0.002 * 0.5 + 0.001 + 3e-4);
    EXPECT_LT(std::abs(spread.mean(1)), 0.001 + 3e-4);
    greatest = std::max(greatest, std::abs(spread.mean(0)));
  }
  EXPECT_GT(greatest, 0.0008);
}

TEST(Sensors, UnknownPresetNamesTheNearest) {
  try {
    simulator::noise_preset("as_recorted");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'as_recorded'?"), std::string::npos);
  }
}

TEST(Sensors, SlopesOfAParabolaAreItsDerivativeWithoutLag) {
  std::vector<Eigen::Vector3d> values;
  for (int i = 0; i < 40; ++i) {
    const double t = 0.25 * i;
    values.emplace_back(t, 0.5 * t * t, 3.0);
  }
  const auto slope = [&](std::size_t i) {
    return simulator::smoothed_slope<3>(values, i, 2, 0.25);
  };
  for (std::size_t i = 2; i + 2 < values.size(); ++i) {
    EXPECT_TRUE(slope(i).isApprox(Eigen::Vector3d(1.0, 0.25 * static_cast<double>(i), 0.0)));
  }
  EXPECT_NEAR(slope(0).x(), 1.0, 1e-12);
  EXPECT_NEAR(slope(values.size() - 1).x(), 1.0, 1e-12);
}

TEST(Sensors, SlopesSmoothWhiteNoise) {
  simulator::VelocitySensors sensors(simulator::noise_preset("stress"), 2);
  std::vector<Eigen::Vector3d> values(4000);
  for (Eigen::Vector3d& value : values) {
    value = sensors.measure(Eigen::Vector3d::Zero());
  }
  double squares = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double slope = simulator::smoothed_slope<3>(values, i, 2, 0.25).x();
    squares += slope * slope;
  }
  // Least squares over five points: sigma / (dt sqrt(10)).
  EXPECT_NEAR(std::sqrt(squares / 4000.0), 0.026 / (0.25 * std::sqrt(10.0)), 0.002);
}

}  // namespace
}  // namespace kelpie::sensors_test
