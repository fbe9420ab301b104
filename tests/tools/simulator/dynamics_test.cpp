// SPDX-License-Identifier: Apache-2.0
#include "simulator/dynamics.hpp"

#include <gtest/gtest.h>

#include "fixtures.hpp"

namespace kelpie::dynamics_test {
namespace {

TEST(Dynamics, MassMatrixIsSymmetricAndPositiveDefinite) {
  RandomStream stream(1, "mass");
  EXPECT_TRUE(simulator::is_symmetric(testing::nominal(testing::dagon()).mass));
  EXPECT_TRUE(simulator::is_positive_definite(testing::nominal(testing::dagon()).mass));
  for (int i = 0; i < 50; ++i) {
    const simulator::Matrix6 mass = testing::nominal(testing::coupled_vehicle(stream)).mass;
    EXPECT_TRUE(simulator::is_symmetric(mass));
    EXPECT_TRUE(simulator::is_positive_definite(mass));
  }
}

// About the origin: the parallel-axis theorem, and sway coupled to roll through the low centre of
// gravity.
TEST(Dynamics, MassMatrixCountsTheCentreOfGravity) {
  const simulator::Matrix6 mass = testing::nominal(testing::dagon()).mass;
  EXPECT_DOUBLE_EQ(mass(0, 0), 85.0);
  EXPECT_DOUBLE_EQ(mass(3, 3), 2.0 + 1.0 + 70.0 * 0.05 * 0.05);
  EXPECT_DOUBLE_EQ(mass(5, 5), 8.5);
  EXPECT_DOUBLE_EQ(mass(0, 4), 70.0 * 0.05);
  EXPECT_DOUBLE_EQ(mass(1, 3), -70.0 * 0.05);
}

TEST(Dynamics, CoriolisIsSkewSymmetricAndDoesNoWork) {
  RandomStream stream(2, "coriolis");
  for (int i = 0; i < 100; ++i) {
    const simulator::Matrix6 mass = testing::nominal(testing::coupled_vehicle(stream)).mass;
    const simulator::Vector6 velocity = testing::random_vector<6>(stream, 2.0);
    const simulator::Matrix6 coriolis = simulator::coriolis_matrix(mass, velocity);
    EXPECT_EQ((coriolis + coriolis.transpose()).norm(), 0.0);
    EXPECT_LT(std::abs(velocity.dot(coriolis * velocity)), 1e-12 * coriolis.norm());
  }
}

// Kirchhoff's equations: momentum M ν is constant in the world while nothing acts, so its rate in
// the body is M ν̇ = −C ν with both halves turning, and the moment of the linear momentum added.
TEST(Dynamics, CoriolisMovesMomentumAsKirchhoffSays) {
  RandomStream stream(3, "kirchhoff");
  const simulator::Matrix6 mass = testing::nominal(testing::coupled_vehicle(stream)).mass;
  const simulator::Vector6 velocity = testing::random_vector<6>(stream, 1.0);
  const simulator::Vector6 momentum = mass * velocity;
  const Eigen::Vector3d turn = velocity.tail<3>();
  const Eigen::Vector3d linear = turn.cross(momentum.head<3>());
  const Eigen::Vector3d angular =
      turn.cross(momentum.tail<3>()) + velocity.head<3>().cross(momentum.head<3>());
  const simulator::Vector6 expected = (simulator::Vector6() << linear, angular).finished();
  EXPECT_LT((simulator::coriolis_matrix(mass, velocity) * velocity - expected).norm(), 1e-12);
}

TEST(Dynamics, SurgeAccelerationIsThrustLessDragOverMass) {
  simulator::VehicleParameters vehicle = testing::lossless_dagon();
  vehicle.centre_of_gravity_m.setZero();  // else surge pitches
  vehicle.linear_damping(0) = 14.0;
  vehicle.quadratic_damping(0) = 5.0;
  const simulator::Dynamics dynamics(testing::nominal(vehicle));
  simulator::RotorSpeeds speeds = simulator::RotorSpeeds::Zero(5);
  speeds.head<2>().setConstant(10.0);
  simulator::Vector6 velocity = simulator::Vector6::Zero();
  velocity(0) = 0.3;
  const double expected = (2 * 0.0262 * 100.0 - 14.0 * 0.3 - 5.0 * 0.09) / 85.0;
  const simulator::Vector6 acceleration =
      dynamics.acceleration(Eigen::Quaterniond::Identity(), velocity, speeds);
  EXPECT_NEAR(acceleration(0), expected, 1e-14);
  EXPECT_LT(acceleration.tail<5>().norm(), 1e-14);
}

TEST(Dynamics, EffectivenessAndDampingFactorScaleWhatTheyName) {
  simulator::Configuration configuration;
  configuration.effectiveness(simulator::kSurgeRight) = 0.5;
  configuration.damping_factor << 1.8, 1.6, 1.0, 1.0, 1.0, 1.5;
  const simulator::Plant before = testing::nominal(testing::dagon());
  const simulator::Plant plant = simulator::make_plant(testing::dagon(), configuration);
  EXPECT_EQ(plant.thrust_axes.col(simulator::kSurgeRight),
            0.5 * before.thrust_axes.col(simulator::kSurgeRight));
  EXPECT_EQ(plant.thrust_axes.col(simulator::kSurgeLeft),
            before.thrust_axes.col(simulator::kSurgeLeft));
  EXPECT_DOUBLE_EQ(plant.linear_damping(0), 1.8 * 14.0);
  EXPECT_DOUBLE_EQ(plant.quadratic_damping(5), 1.5 * 1.0);
  EXPECT_EQ(plant.mass, before.mass);
}

// Two halves of the vehicle, one of them carried as payload, are the whole vehicle.
TEST(Dynamics, PayloadCountsLikeAPartOfTheVehicle) {
  const simulator::VehicleParameters whole = testing::dagon();
  simulator::VehicleParameters half = whole;
  half.mass_kg /= 2.0;
  half.inertia_kg_m2 /= 2.0;
  half.added_mass /= 2.0;
  half.net_buoyancy_n /= 2.0;
  simulator::Configuration configuration;
  configuration.payload = {.mass_kg = half.mass_kg,
                           .position_m = whole.centre_of_gravity_m,
                           .inertia_kg_m2 = half.inertia_kg_m2,
                           .added_mass = half.added_mass,
                           .buoyancy_n = half.mass_kg * simulator::kGravity + half.net_buoyancy_n};
  const simulator::Plant expected = testing::nominal(whole);
  const simulator::Plant plant = simulator::make_plant(half, configuration);
  EXPECT_TRUE(plant.mass.isApprox(expected.mass, 1e-14));
  EXPECT_NEAR(plant.net_weight_n, expected.net_weight_n, 1e-12);
}

TEST(Dynamics, APullActsWhereItIsAttached) {
  simulator::Configuration pulled;
  pulled.pull_n = {-8.5, 4.0, 0.0};
  pulled.pull_position_m = {-0.5, 0.0, 0.0};
  const simulator::Plant plant = simulator::make_plant(testing::dagon(), pulled);
  EXPECT_EQ(plant.pull, (simulator::Vector6() << -8.5, 4.0, 0.0, 0.0, 0.0, -2.0).finished());
  simulator::VehicleParameters vehicle = testing::dagon();
  vehicle.centre_of_gravity_m.setZero();
  const simulator::Dynamics dynamics(simulator::make_plant(vehicle, pulled));
  const simulator::Vector6 acceleration = dynamics.acceleration(
      Eigen::Quaterniond::Identity(), simulator::Vector6::Zero(), simulator::RotorSpeeds::Zero(5));
  EXPECT_NEAR(acceleration(0), -8.5 / 85.0, 1e-12);
}

TEST(Dynamics, BlendIsEitherPlantAtItsEndAndBothBetween) {
  simulator::Configuration changed;
  changed.effectiveness(simulator::kSway) = 0.5;
  changed.damping_factor(1) = 3.0;
  changed.payload.mass_kg = 10.0;
  const simulator::Plant from = testing::nominal(testing::dagon());
  const simulator::Plant to = simulator::make_plant(testing::dagon(), changed);
  EXPECT_EQ(simulator::blend(from, to, 0.0).mass, from.mass);
  EXPECT_EQ(simulator::blend(from, to, 1.0).mass, to.mass);
  const simulator::Plant half = simulator::blend(from, to, 0.5);
  EXPECT_DOUBLE_EQ(half.mass(0, 0), 85.0 + 5.0);
  EXPECT_DOUBLE_EQ(half.linear_damping(1), 2.0 * 15.0);
  EXPECT_DOUBLE_EQ(half.thrust_axes(1, simulator::kSway), 0.75);
  EXPECT_DOUBLE_EQ(half.net_weight_n, -5.0 + 5.0 * simulator::kGravity);
}

}  // namespace
}  // namespace kelpie::dynamics_test
