// SPDX-License-Identifier: Apache-2.0
#include "lab/closed_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "lab/controllers.hpp"
#include "simulator/scenario_file.hpp"

namespace kelpie::closed_loop_test {
namespace {

using namespace lab;

simulator::VehicleParameters dagon() {
  return simulator::read_scenario(std::filesystem::path(KELPIE_SOURCE_DIR) / "scenarios" /
                                  "small.toml")
      .vehicle;
}

constexpr MissionTimes kShort{
    .settle_s = 20.0, .before_s = 30.0, .during_s = 20.0, .after_s = 30.0};

TEST(MissionPath, TheFigureOfEightComesBackToWhereItWas) {
  MissionPath path(PathKind::figure_of_eight);
  const auto advance = [&](double seconds) {
    for (int k = 0; k < static_cast<int>(seconds / 0.1); ++k) {
      path.advance(0.1);
    }
    return path.reference().pose;
  };
  const Pose2 once = advance(200.0);
  const Pose2 twice = advance(200.0);
  EXPECT_LT((twice - once).norm(), 0.02);
  EXPECT_GT((advance(100.0) - once).head<2>().norm() + (advance(25.0) - once).head<2>().norm(),
            1.0);
}

TEST(NominalModel, AllocatesWhatItsForcesAre) {
  const NominalModel nominal(dagon());
  const Eigen::Vector3d wanted(2.0, -1.0, 0.3);
  EXPECT_LT((nominal.forces(nominal.allocate(wanted)) - wanted).norm(), 1e-9);
}

// To millimetres with a feed-forward or adaptation, to a centimetre without.
TEST(ClosedLoop, TheNominalVehicleFollowsUnderEveryController) {
  const simulator::VehicleParameters vehicle = dagon();
  const NominalModel nominal(vehicle);
  const Mission mission{.path = PathKind::figure_of_eight, .times = kShort};
  const double pid = fly(vehicle, mission, *make_pid(nominal, false)).before;
  EXPECT_LT(pid, 0.03);
  EXPECT_LT(fly(vehicle, mission, *make_pid(nominal, true)).before, 0.3 * pid);
  EXPECT_LT(fly(vehicle, mission, *make_adaptive(nominal)).before, 0.5 * pid);
  EXPECT_LT(fly(vehicle, mission, *make_predictive(nominal)).before, 0.003);
}

// Metres away its thrusters are at their limits, never beyond.
TEST(PredictiveControl, KeepsTheLimitsOfTheThrusters) {
  const NominalModel nominal(dagon());
  const std::unique_ptr<Controller> controller = make_predictive(nominal);
  double fullest = 0.0;
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector3d commands = controller->update(
        {.pose = {20.0, -5.0, 2.0}}, {.time_s = 0.1 * k, .rotors_rps = 0.5 * nominal.most_rps});
    ASSERT_TRUE((commands.cwiseAbs().array() <= nominal.most_rps.array() + 1e-9).all());
    fullest = std::max(fullest, (commands.cwiseAbs().cwiseQuotient(nominal.most_rps)).maxCoeff());
  }
  EXPECT_GT(fullest, 0.99);
}

// A current turns by 90 degrees, which the model doesn't know: no offset is left.
TEST(PredictiveControl, HoldsItsPlaceInACurrent) {
  const simulator::VehicleParameters vehicle = dagon();
  const std::unique_ptr<Controller> controller = make_predictive(NominalModel(vehicle));
  const MissionErrors flown =
      fly(vehicle, {.path = PathKind::station, .mishap = Mishap::current, .times = kShort},
          *controller);
  EXPECT_LT(flown.during, 0.01);
  EXPECT_LT(flown.after, 0.003);
}

// A model that knows nothing leaves the vehicle to the nominal one.
TEST(ClosedLoop, FallsBackWithoutAModel) {
  const simulator::VehicleParameters vehicle = dagon();
  const NominalModel nominal(vehicle);
  const Mission mission{
      .path = PathKind::lawn_mower,
      .mishap = Mishap::thruster,
      .times = {.settle_s = 1.0, .before_s = 1.0, .during_s = 1.0, .after_s = 1.0}};
  const std::unique_ptr<Controller> untaught = make_learned(nominal, untaught_model());
  const MissionErrors learned = fly(vehicle, mission, *untaught);
  const MissionErrors nominally = fly(vehicle, mission, *make_pid(nominal, true));
  EXPECT_GT(learned.fallback_share, 0.99);
  EXPECT_LT(learned.after, 1.2 * nominally.after + 0.001);
}

// The nominal vehicle's own equation bridges twenty seconds without velocities and positions.
TEST(ClosedLoop, AnOutageIsBridged) {
  const simulator::VehicleParameters vehicle = dagon();
  const NominalModel nominal(vehicle);
  const Mission mission{
      .path = PathKind::figure_of_eight, .mishap = Mishap::outage, .times = kShort};
  const MissionErrors flown = fly(vehicle, mission, *make_pid(nominal, true));
  EXPECT_LT(flown.during, 0.1);
  EXPECT_LT(flown.after, 0.1);
}

// After a commissioning drive of the nominal vehicle, which takes seconds: driven once.
const DynamicsModel& commissioned_model() {
  static const DynamicsModel model = commissioned(dagon(), 600.0, 1001);
  return model;
}

// Within the first minute no further away than without, since no jump of the commands comes with
// the diagnosis; from then on less than half as far.
TEST(ClosedLoop, ReallocationMakesUpForALostThruster) {
  const simulator::VehicleParameters vehicle = dagon();
  const NominalModel nominal(vehicle);
  const DynamicsModel& model = commissioned_model();
  for (const PathKind path : {PathKind::lawn_mower, PathKind::figure_of_eight}) {
    const Mission mission{.path = path, .mishap = Mishap::thruster};
    const MissionErrors plain = fly(vehicle, mission, *make_pid(nominal, true));
    const MissionErrors reallocated =
        fly(vehicle, mission, *make_pid(nominal, true, model.diagnosis()));
    EXPECT_LT(reallocated.during, 1.02 * plain.during) << path_name(path);
    EXPECT_LT(reallocated.after, 0.5 * plain.after) << path_name(path);
  }
}

// The current has set in four minutes before position and velocities fall silent for a minute: the
// model learned meanwhile has taken the current for dynamics.
TEST(ClosedLoop, KnowsTheCurrentThroughAnOutage) {
  const simulator::VehicleParameters vehicle = dagon();
  const NominalModel nominal(vehicle);
  const DynamicsModel& model = commissioned_model();
  for (const PathKind path : {PathKind::lawn_mower, PathKind::figure_of_eight}) {
    const Mission mission{.path = path, .mishap = Mishap::outage_current};
    const MissionErrors learned = fly(vehicle, mission, *make_learned(nominal, model));
    EXPECT_LT(learned.during, 0.15) << path_name(path);  // m; 0.08 m/s for a minute is 4.8 m
  }
}

// In a current the thrusters are whole: with a diagnosis the vehicle follows as well as without.
TEST(ClosedLoop, ReallocationDoesNoHarmInACurrent) {
  const simulator::VehicleParameters vehicle = dagon();
  const NominalModel nominal(vehicle);
  const Mission mission{.path = PathKind::lawn_mower, .mishap = Mishap::current};
  const DynamicsModel& model = commissioned_model();
  const MissionErrors plain = fly(vehicle, mission, *make_learned(nominal, model));
  const MissionErrors reallocated = fly(vehicle, mission, *make_learned(nominal, model, true));
  EXPECT_LT(plain.after, 0.02);
  EXPECT_LT(reallocated.after, 1.2 * plain.after);
}

TEST(SlopeWindow, GivesTheSlopeOfTheMiddle) {
  SlopeWindow window;
  std::optional<std::pair<Sensed, Eigen::Vector3d>> sample;
  for (int k = 0; k < 5; ++k) {
    const double t = 0.1 * k;
    EXPECT_FALSE(sample);
    sample = window.add({.time_s = t, .velocity = {t * t, 2.0 * t, 1.0}});
  }
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->first.time_s, 0.2, 1e-12);
  EXPECT_NEAR(sample->second.x(), 0.4, 1e-12);
  EXPECT_NEAR(sample->second.y(), 2.0, 1e-12);
  EXPECT_NEAR(sample->second.z(), 0.0, 1e-12);
}

}  // namespace
}  // namespace kelpie::closed_loop_test
