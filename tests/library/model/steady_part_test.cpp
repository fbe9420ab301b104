// SPDX-License-Identifier: Apache-2.0
#include "model/steady_part.hpp"

#include <gtest/gtest.h>

#include "kelpie/motion/term_set.hpp"
#include "model/planar_drive.hpp"
#include "motion/states.hpp"

namespace kelpie::steady_part_test {
namespace {

using testing::PlanarDrive;

constexpr std::array<std::size_t, 2> kStates{0, 1};

TermSet terms() {
  return TermSet::open_loop(PlanarDrive{}.inputs, kStates);
}

SteadyPart learned(const PlanarDrive& drive) {
  SteadyPart part(terms(), 4, {kStates.begin(), kStates.end()});
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    part.observe(drive.x[i], drive.y[i], drive.t[i]);
  }
  return part;
}

double worst_error(const SteadyModel& model, const PlanarDrive& drive, std::size_t axis) {
  const TermSet set = terms();
  std::vector<double> phi(set.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    set.evaluate(drive.x[i], phi);
    worst = std::max(worst, std::abs(model.acceleration(phi) - drive.y[i][axis]));
  }
  return worst;
}

TEST(SteadyPart, FindsTheEquationsOfMotionFromVelocitiesAlone) {
  PlanarDrive drive;
  drive.drive(1, 2000, 0.1);
  PlanarDrive other;
  other.drive(2, 500, 0.1);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const SteadyModel model = learned(drive).model(axis);
    ASSERT_TRUE(model.ready());
    EXPECT_LT(worst_error(model, other, axis), 0.01);  // of accelerations up to 0.6
    EXPECT_LT(model.error, 0.01);
    EXPECT_EQ(model.state, axis);
  }
}

TEST(SteadyPart, StepsOverGapsAndCuts) {
  PlanarDrive drive;
  drive.drive(1, 2000, 0.1);
  PlanarDrive cut = drive;
  for (std::size_t i = 1000; i < cut.t.size(); ++i) {
    cut.t[i] += 3600.0;  // an hour later, where the vehicle goes on as if nothing had happened
  }
  for (std::size_t i = 1500; i < cut.x.size(); ++i) {
    cut.x[i] = cut.x[i - 700];  // another place of the log, without a gap in time
    cut.y[i] = cut.y[i - 700];
  }
  PlanarDrive other;
  other.drive(2, 500, 0.1);
  const SteadyPart part = learned(cut);
  EXPECT_NEAR(static_cast<double>(part.steps()), 997.0, 3.0);  // two samples each
  EXPECT_LT(worst_error(part.model(0), other, 0), 0.02);
}

TEST(SteadyPart, ServesOnAfterAChangeUntilItKnowsBetter) {
  PlanarDrive drive;
  drive.drive(1, 1000, 0.1);
  SteadyPart part = learned(drive);
  part.restart();
  EXPECT_LT(worst_error(part.model(0), drive, 0), 0.01);
  PlanarDrive damaged;
  damaged.drive(3, 1500, 0.1, 0.5);
  EXPECT_GT(worst_error(part.model(0), damaged, 0), 0.1);
  for (std::size_t i = 0; i < damaged.x.size(); ++i) {
    part.observe(damaged.x[i], damaged.y[i], drive.t.back() + 1.0 + damaged.t[i]);
    ASSERT_TRUE(part.model(0).ready()) << i;
  }
  EXPECT_LT(worst_error(part.model(0), damaged, 0), 0.05);
  EXPECT_LT(part.model(0).error, 0.03);
}

TEST(SteadyPart, ForgetsWhatIsNoModelYetWhenTheVehicleHasChanged) {
  PlanarDrive drive;
  drive.drive(1, 150, 0.1);
  SteadyPart part = learned(drive);
  part.restart();
  EXPECT_EQ(part.steps(), 0);
  EXPECT_FALSE(part.model(0).ready());
}

TEST(SteadyPart, TellsTheErrorOfWhatItDoesntKnowAndHowLongItLasts) {
  constexpr double kError = 0.05;
  constexpr double kLasting = 2.0;
  PlanarDrive drive;
  drive.drive(1, 6000, 0.1);
  RandomStream random(5, "disturbance");
  const double keep = std::exp(-0.1 / kLasting);
  double disturbance = 0.0;
  for (std::array<double, 2>& y : drive.y) {
    disturbance = keep * disturbance + std::sqrt(1.0 - keep * keep) * kError * random.normal();
    y[0] += disturbance;
  }
  const SteadyModel model = learned(drive).model(0);
  EXPECT_NEAR(model.error, kError, 0.3 * kError);
  EXPECT_NEAR(model.error_time_s, kLasting, 0.5 * kLasting);
}

// What a thruster's inflow adds to the accelerations: the products' share, root mean square.
double products(const SteadyModel& model, const PlanarDrive& drive) {
  const TermSet set = terms();
  std::vector<double> phi(set.size());
  double sum = 0.0;
  for (const std::array<double, 4>& x : drive.x) {
    set.evaluate(x, phi);
    double share = 0.0;
    for (std::size_t k = set.without_products(); k < set.size(); ++k) {
      share += model.weights[k] * phi[k];
    }
    sum += share * share;
  }
  return std::sqrt(sum / static_cast<double>(drive.x.size()));
}

// A gust of wind that lasts isn't an inflow.
TEST(SteadyPart, BelievesInProductsOnlyWhatTheDataShow) {
  PlanarDrive drive;
  drive.drive(1, 600, 0.1);
  PlanarDrive windy = drive;
  RandomStream random(7, "wind");
  double wind = 0.0;
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    wind = 0.98 * wind + 0.06 * random.normal();
    windy.x[i][0] += 0.1 * wind;
    windy.y[i][0] += wind;
  }
  ASSERT_EQ(terms().text(terms().without_products()), "n1*u");
  EXPECT_LT(products(learned(windy).model(0), windy), 0.05);
  EXPECT_LT(products(learned(drive).model(0), drive), 0.01);
}

TEST(SteadyPart, TellsTheNoiseOfVelocities) {
  PlanarDrive drive;
  drive.drive(1, 3000, 0.1);
  RandomStream random(6, "noise");
  for (std::array<double, 4>& x : drive.x) {
    x[0] += 0.01 * random.normal();
  }
  EXPECT_NEAR(learned(drive).model(0).noise, 0.01, 0.001);
}

TEST(SteadyPart, SaysWhatRangeOfInputsItHasSeen) {
  PlanarDrive drive;
  drive.drive(1, 500, 0.1);
  const SteadyModel model = learned(drive).model(1);
  ASSERT_EQ(model.seen.size(), 4U);
  for (std::size_t input = 0; input < 4; ++input) {
    double low = drive.x[0][input];
    double high = low;
    for (const std::array<double, 4>& x : drive.x) {
      low = std::min(low, x[input]);
      high = std::max(high, x[input]);
    }
    EXPECT_EQ(model.seen[input].low, low);
    EXPECT_EQ(model.seen[input].high, high);
  }
}

// The window grows with the noise of velocity, so that the equations are found where one step of
// 0.2 s is hardly more than noise; without noise it stays short.
TEST(SteadyPart, MatchesItsWindowToTheNoiseOfVelocity) {
  PlanarDrive clean;
  clean.drive(1, 6000, 0.1);
  PlanarDrive other;
  other.drive(2, 500, 0.1);
  double before_s = -1.0;
  for (const double noise : {0.0, 0.003, 0.03}) {
    PlanarDrive drive = clean;
    RandomStream random(4, "noise");
    for (std::array<double, 4>& x : drive.x) {
      x[0] += noise * random.normal();
      x[1] += noise * random.normal();
    }
    const SteadyPart part = learned(drive);
    EXPECT_GT(part.window_s(), before_s) << noise;
    before_s = part.window_s();
    EXPECT_LT(worst_error(part.model(0), other, 0), 0.01 + 2.0 * noise);
  }
  EXPECT_GT(before_s, 0.3);
  EXPECT_LT(before_s, 20.0);
}

}  // namespace
}  // namespace kelpie::steady_part_test
