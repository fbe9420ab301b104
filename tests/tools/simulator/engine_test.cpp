// SPDX-License-Identifier: Apache-2.0
#include "simulator/engine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "simulator/dynamics.hpp"
#include "simulator/fixtures.hpp"
#include "simulator/integrator.hpp"
#include "simulator/stability.hpp"

namespace kelpie::engine_test {
namespace {

using simulator::Engine;
using simulator::EngineBody;
using simulator::EngineRun;
using simulator::EngineState;
using simulator::EngineTerm;
using simulator::Matrix6;
using simulator::StepForm;
using simulator::Vector6;

constexpr std::array kAllAxes{true, true, true, true, true, true};

Engine named(const std::string& name) {
  for (const Engine& engine : simulator::engines()) {
    if (engine.name == name) {
      return engine;
    }
  }
  ADD_FAILURE() << name;
  return {};
}

EngineState driven(const Engine& engine, const EngineBody& body, EngineState state,
                   const Vector6& force, double seconds, double step_s) {
  const EngineRun run(engine, body, step_s);
  for (long step = std::lround(seconds / step_s); step > 0; --step) {
    state = run.next(state, force);
  }
  return state;
}

// A ball of 10 kg that only inertia and added mass hold back.
EngineBody ball(double added_share) {
  EngineBody body;
  body.mass_kg = 10.0;
  body.inertia_kg_m2 = Eigen::Matrix3d::Identity();
  body.added_mass.diagonal() << Eigen::Vector3d::Constant(10.0 * added_share),
      Eigen::Vector3d::Constant(added_share);
  return body;
}

EngineState at_rest() {
  return EngineState::at(Eigen::Quaterniond::Identity(), Vector6::Zero());
}

// The project's simulator is checked against DART; an engine shares only C(ν) with the simulator.
TEST(Engine, DrivesLikeTheSimulatorWhereAddedMassIsJoined) {
  RandomStream stream(7, "engine");
  const simulator::VehicleParameters vehicle = testing::coupled_vehicle(stream);
  const simulator::Dynamics dynamics(testing::nominal(vehicle));
  const simulator::State start = testing::random_state(stream);
  const Vector6 truth = testing::after(dynamics, start, 2.0, 0.001).velocity;
  const EngineBody body = simulator::engine_body(vehicle, kAllAxes);
  for (const char* const name : {"kelpie", "gazebo", "mss", "python_vehicle_simulator"}) {
    const EngineState first = EngineState::at(start.attitude, start.velocity);
    const auto error = [&](double step_s) {
      return (driven(named(name), body, first, Vector6::Zero(), 2.0, step_s).velocity - truth)
          .norm();
    };
    const double coarse = error(0.004);
    const double fine = error(0.002);
    EXPECT_LT(fine, 0.02 * truth.norm()) << name;
    if (named(name).step != StepForm::runge_kutta) {
      EXPECT_NEAR(coarse / fine, 2.0, 0.2) << name << ": first order";
    }
  }
}

// Where a force stands for the added mass, the limit of short steps is the joined equation.
TEST(Engine, AForceForTheAddedMassConvergesToTheJoinedEquation) {
  RandomStream stream(3, "engine");
  simulator::VehicleParameters vehicle = testing::dagon();
  vehicle.centre_of_gravity_m = {0.02, 0.01, 0.05};
  vehicle.added_mass *= 0.5;  // pitch has more than the body's own inertia
  const EngineBody body = simulator::engine_body(vehicle, kAllAxes);
  const EngineState first =
      EngineState::at(Eigen::Quaterniond::Identity(), testing::random_vector<6>(stream, 0.3));
  const Vector6 force = testing::random_vector<6>(stream, 5.0);
  const Vector6 truth = driven(named("kelpie"), body, first, force, 3.0, 0.001).velocity;
  Engine plugin = named("gazebo_plugin");
  plugin.added_coriolis = true;
  for (const Engine& engine : {plugin, named("uuv_simulator")}) {
    const auto error = [&](double step_s) {
      return (driven(engine, body, first, force, 3.0, step_s).velocity - truth).norm();
    };
    const double coarse = error(0.002);
    const double fine = error(0.001);
    EXPECT_LT(fine, 0.01 * truth.norm()) << engine.name;
    EXPECT_LT(fine, 0.7 * coarse) << engine.name;
  }
}

// Steps in world axes keep the momentum of a free body, whatever the step.
TEST(Engine, AFreeBodyKeepsItsMomentumInWorldAxes) {
  RandomStream stream(11, "engine");
  EngineBody body = ball(0.0);
  body.centre_of_gravity_m = {0.1, -0.2, 0.3};
  const EngineState first =
      EngineState::at(Eigen::Quaterniond(testing::random_vector<4>(stream, 1.0)).normalized(),
                      testing::random_vector<6>(stream, 1.0));
  const auto momentum = [&](const EngineState& state) {
    const Eigen::Vector3d omega = state.velocity.tail<3>();
    return (body.mass_kg *
            (state.attitude * (state.velocity.head<3>() + omega.cross(body.centre_of_gravity_m))))
        .eval();
  };
  const EngineState last = driven(named("uuv_simulator"), body, first, Vector6::Zero(), 5.0, 0.01);
  EXPECT_LT((momentum(last) - momentum(first)).norm(), 1e-9);
  EXPECT_GT((last.velocity - first.velocity).norm(), 0.1) << "the body tumbles";
}

TEST(Engine, TheMeanOfAddedMassesLosesTheDifferenceOfAxes) {
  EngineBody body = ball(0.0);
  body.added_mass.diagonal() << 3.0, 6.0, 9.0, 0.5, 1.0, 2.0;
  const EngineRun run(named("stonefish"), body, 0.01);
  const Vector6 force = (Vector6() << 1, 1, 1, 1, 1, 1).finished();
  const Vector6 velocity = run.next(at_rest(), force).velocity;
  const Vector6 expected =
      0.01 * (Vector6() << 1 / 16.0, 1 / 16.0, 1 / 16.0, 1 / 1.5, 0.5, 1 / 3.0).finished();
  EXPECT_LT((velocity - expected).norm(), 1e-6) << "the step turns the body a little";
}

TEST(Engine, AxesThatAreHeldStayAtRest) {
  const EngineBody body =
      simulator::engine_body(testing::dagon(), {true, true, false, false, false, true});
  const Vector6 force = Vector6::Constant(3.0);
  for (const Engine& engine : simulator::engines()) {
    const Vector6 velocity = driven(engine, body, at_rest(), force, 0.2, engine.step_s).velocity;
    EXPECT_EQ(velocity.segment<3>(2).norm(), 0.0) << engine.name;
    EXPECT_GT(velocity(0) * velocity(1) * velocity(5), 0.0) << engine.name;
  }
}

// With d_k = ν_k − ν_k−1: d_k+1 = −(a/m) d_k, for every step. Mateus Menezes found the bound by
// experiment (gz-sim issue 1923).
TEST(StepLimit, AddedMassAboveMassHasNoStableStepWhereTheLastAccelerationIsUsed) {
  const Engine plugin = named("gazebo_plugin");
  for (const double step_s : {0.001, 0.01}) {
    const simulator::Growth growth =
        simulator::fastest_growth(EngineRun(plugin, ball(1.3), step_s), at_rest());
    EXPECT_NEAR(growth.per_s, std::log(1.3) / step_s, 1e-3 / step_s);
  }
  const simulator::StepLimit heavy = simulator::step_limit(plugin, ball(1.01), {});
  EXPECT_FALSE(heavy.stable);
  EXPECT_FALSE(heavy.largest_s.has_value());
  EXPECT_EQ(heavy.term, EngineTerm::added_mass);
  const simulator::StepLimit light = simulator::step_limit(plugin, ball(0.99), {});
  EXPECT_TRUE(light.stable);
  EXPECT_EQ(light.largest_s, simulator::StepLimit::kMostS);
}

// f_k+1 = (1 − α − α a/m) f_k: stable up to a/m = 2/α − 1.
TEST(StepLimit, AFilterOfTheAccelerationMovesTheBound) {
  const Engine uuv = named("uuv_simulator");
  const double bound = 2.0 / 0.3 - 1.0;
  EXPECT_TRUE(simulator::step_limit(uuv, ball(bound - 0.05), {}).stable);
  EXPECT_FALSE(simulator::step_limit(uuv, ball(bound + 0.05), {}).stable);
}

// Euler: |1 − h d/m| <= 1.
TEST(StepLimit, DragBoundsTheStepAndIsNamed) {
  EngineBody body = ball(0.0);
  body.linear_damping(2) = 100.0;
  const simulator::StepLimit limit =
      simulator::step_limit(named("python_vehicle_simulator"), body, {});
  ASSERT_TRUE(limit.largest_s.has_value());
  EXPECT_NEAR(*limit.largest_s, 2.0 * 10.0 / 100.0, 0.005);
  EXPECT_EQ(limit.term, EngineTerm::linear_damping);
  EXPECT_EQ(limit.axis, 2U);
  body.linear_damping(2) = 0.0;
  body.quadratic_damping(0) = 50.0;
  const EngineState fast = EngineState::at(Eigen::Quaterniond::Identity(), Vector6::Unit(0));
  const simulator::StepLimit quadratic =
      simulator::step_limit(named("python_vehicle_simulator"), body, {{fast}});
  EXPECT_NEAR(quadratic.largest_s.value_or(0.0), 2.0 * 10.0 / 100.0, 0.005);
  EXPECT_EQ(quadratic.term, EngineTerm::quadratic_damping);
}

// A pendulum: velocities first do not grow until h = 2/ω, Runge-Kutta's method until h = √8/ω.
TEST(StepLimit, RestoringForcesBoundTheStepAndAreNamed) {
  EngineBody body = ball(0.0);
  body.weight_moment_nm = {0.0, 0.0, 25.0};  // ω = 5 rad/s in roll and pitch
  const simulator::StepLimit fourth_order = simulator::step_limit(named("mss"), body, {});
  EXPECT_NEAR(fourth_order.largest_s.value_or(0.0), std::sqrt(8.0) / 5.0, 0.02);
  EXPECT_EQ(fourth_order.term, EngineTerm::restoring);
  const simulator::StepLimit symplectic = simulator::step_limit(named("gazebo"), body, {});
  EXPECT_TRUE(symplectic.stable);
  EXPECT_NEAR(symplectic.largest_s.value_or(0.0), 0.4, 0.01);
  EXPECT_EQ(symplectic.term, EngineTerm::restoring);
}

}  // namespace
}  // namespace kelpie::engine_test
