// SPDX-License-Identifier: Apache-2.0
#include "vehicle/dynamics.hpp"

#include <gtest/gtest.h>

#include "fixtures.hpp"

namespace kelpie::dynamics_test {
namespace {

TEST(Dynamics, MassMatrixIsSymmetricAndPositiveDefinite) {
  RandomStream stream(1, "mass");
  EXPECT_TRUE(vehicle::is_symmetric(testing::nominal(testing::dagon()).mass));
  EXPECT_TRUE(vehicle::is_positive_definite(testing::nominal(testing::dagon()).mass));
  for (int i = 0; i < 50; ++i) {
    const vehicle::Matrix6 mass = testing::nominal(testing::coupled_vehicle(stream)).mass;
    EXPECT_TRUE(vehicle::is_symmetric(mass));
    EXPECT_TRUE(vehicle::is_positive_definite(mass));
  }
}

// About the origin: the parallel-axis theorem, and sway coupled to roll through the low centre of
// gravity.
TEST(Dynamics, MassMatrixCountsTheCentreOfGravity) {
  const vehicle::Matrix6 mass = testing::nominal(testing::dagon()).mass;
  EXPECT_DOUBLE_EQ(mass(0, 0), 85.0);
  EXPECT_DOUBLE_EQ(mass(3, 3), 2.0 + 1.0 + 70.0 * 0.05 * 0.05);
  EXPECT_DOUBLE_EQ(mass(5, 5), 8.5);
  EXPECT_DOUBLE_EQ(mass(0, 4), 70.0 * 0.05);
  EXPECT_DOUBLE_EQ(mass(1, 3), -70.0 * 0.05);
}

TEST(Dynamics, CoriolisIsSkewSymmetricAndDoesNoWork) {
  RandomStream stream(2, "coriolis");
  for (int i = 0; i < 100; ++i) {
    const vehicle::Matrix6 mass = testing::nominal(testing::coupled_vehicle(stream)).mass;
    const vehicle::Vector6 velocity = testing::random_vector<6>(stream, 2.0);
    const vehicle::Matrix6 coriolis = vehicle::coriolis_matrix(mass, velocity);
    EXPECT_EQ((coriolis + coriolis.transpose()).norm(), 0.0);
    EXPECT_LT(std::abs(velocity.dot(coriolis * velocity)), 1e-12 * coriolis.norm());
  }
}

// Kirchhoff's equations: momentum M ν is constant in the world while nothing acts, so its rate in
// the body is M ν̇ = −C ν with both halves turning, and the moment of the linear momentum added.
TEST(Dynamics, CoriolisMovesMomentumAsKirchhoffSays) {
  RandomStream stream(3, "kirchhoff");
  const vehicle::Matrix6 mass = testing::nominal(testing::coupled_vehicle(stream)).mass;
  const vehicle::Vector6 velocity = testing::random_vector<6>(stream, 1.0);
  const vehicle::Vector6 momentum = mass * velocity;
  const Eigen::Vector3d turn = velocity.tail<3>();
  const Eigen::Vector3d linear = turn.cross(momentum.head<3>());
  const Eigen::Vector3d angular =
      turn.cross(momentum.tail<3>()) + velocity.head<3>().cross(momentum.head<3>());
  const vehicle::Vector6 expected = (vehicle::Vector6() << linear, angular).finished();
  EXPECT_LT((vehicle::coriolis_matrix(mass, velocity) * velocity - expected).norm(), 1e-12);
}

TEST(Dynamics, SurgeAccelerationIsThrustLessDragOverMass) {
  vehicle::VehicleParameters vehicle = testing::lossless_dagon();
  vehicle.centre_of_gravity_m.setZero();  // else surge pitches
  vehicle.linear_damping(0) = 14.0;
  vehicle.quadratic_damping(0) = 5.0;
  const vehicle::Dynamics dynamics(testing::nominal(vehicle));
  vehicle::RotorSpeeds speeds = vehicle::RotorSpeeds::Zero(5);
  speeds.head<2>().setConstant(10.0);
  vehicle::Vector6 velocity = vehicle::Vector6::Zero();
  velocity(0) = 0.3;
  const double expected = (2 * 0.0262 * 100.0 - 14.0 * 0.3 - 5.0 * 0.09) / 85.0;
  const vehicle::Vector6 acceleration =
      dynamics.acceleration(Eigen::Quaterniond::Identity(), velocity, speeds);
  EXPECT_NEAR(acceleration(0), expected, 1e-14);
  EXPECT_LT(acceleration.tail<5>().norm(), 1e-14);
}

TEST(Dynamics, EffectivenessAndDampingFactorScaleWhatTheyName) {
  vehicle::Configuration configuration;
  configuration.effectiveness(vehicle::kSurgeRight) = 0.5;
  configuration.damping_factor << 1.8, 1.6, 1.0, 1.0, 1.0, 1.5;
  const vehicle::Plant before = testing::nominal(testing::dagon());
  const vehicle::Plant plant = vehicle::make_plant(testing::dagon(), configuration);
  EXPECT_EQ(plant.thrust_axes.col(vehicle::kSurgeRight),
            0.5 * before.thrust_axes.col(vehicle::kSurgeRight));
  EXPECT_EQ(plant.thrust_axes.col(vehicle::kSurgeLeft),
            before.thrust_axes.col(vehicle::kSurgeLeft));
  EXPECT_DOUBLE_EQ(plant.linear_damping(0), 1.8 * 14.0);
  EXPECT_DOUBLE_EQ(plant.quadratic_damping(5), 1.5 * 1.0);
  EXPECT_EQ(plant.mass, before.mass);
}

// Two halves of the vehicle, one of them carried as payload, are the whole vehicle.
TEST(Dynamics, PayloadCountsLikeAPartOfTheVehicle) {
  const vehicle::VehicleParameters whole = testing::dagon();
  vehicle::VehicleParameters half = whole;
  half.mass_kg /= 2.0;
  half.inertia_kg_m2 /= 2.0;
  half.added_mass /= 2.0;
  half.net_buoyancy_n /= 2.0;
  vehicle::Configuration configuration;
  configuration.payload = {.mass_kg = half.mass_kg,
                           .position_m = whole.centre_of_gravity_m,
                           .inertia_kg_m2 = half.inertia_kg_m2,
                           .added_mass = half.added_mass,
                           .buoyancy_n = half.mass_kg * vehicle::kGravity + half.net_buoyancy_n};
  const vehicle::Plant expected = testing::nominal(whole);
  const vehicle::Plant plant = vehicle::make_plant(half, configuration);
  EXPECT_TRUE(plant.mass.isApprox(expected.mass, 1e-14));
  EXPECT_NEAR(plant.net_weight_n, expected.net_weight_n, 1e-12);
}

TEST(Dynamics, APullActsWhereItIsAttached) {
  vehicle::Configuration pulled;
  pulled.pull_n = {-8.5, 4.0, 0.0};
  pulled.pull_position_m = {-0.5, 0.0, 0.0};
  const vehicle::Plant plant = vehicle::make_plant(testing::dagon(), pulled);
  EXPECT_EQ(plant.pull, (vehicle::Vector6() << -8.5, 4.0, 0.0, 0.0, 0.0, -2.0).finished());
  vehicle::VehicleParameters vehicle = testing::dagon();
  vehicle.centre_of_gravity_m.setZero();
  const vehicle::Dynamics dynamics(vehicle::make_plant(vehicle, pulled));
  const vehicle::Vector6 acceleration = dynamics.acceleration(
      Eigen::Quaterniond::Identity(), vehicle::Vector6::Zero(), vehicle::RotorSpeeds::Zero(5));
  EXPECT_NEAR(acceleration(0), -8.5 / 85.0, 1e-12);
}

TEST(Dynamics, BlendIsEitherPlantAtItsEndAndBothBetween) {
  vehicle::Configuration changed;
  changed.effectiveness(vehicle::kSway) = 0.5;
  changed.damping_factor(1) = 3.0;
  changed.payload.mass_kg = 10.0;
  const vehicle::Plant from = testing::nominal(testing::dagon());
  const vehicle::Plant to = vehicle::make_plant(testing::dagon(), changed);
  EXPECT_EQ(vehicle::blend(from, to, 0.0).mass, from.mass);
  EXPECT_EQ(vehicle::blend(from, to, 1.0).mass, to.mass);
  const vehicle::Plant half = vehicle::blend(from, to, 0.5);
  EXPECT_DOUBLE_EQ(half.mass(0, 0), 85.0 + 5.0);
  EXPECT_DOUBLE_EQ(half.linear_damping(1), 2.0 * 15.0);
  EXPECT_DOUBLE_EQ(half.thrust_axes(1, vehicle::kSway), 0.75);
  EXPECT_DOUBLE_EQ(half.net_weight_n, -5.0 + 5.0 * vehicle::kGravity);
}

}  // namespace
}  // namespace kelpie::dynamics_test
