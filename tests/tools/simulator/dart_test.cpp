// SPDX-License-Identifier: Apache-2.0
//
// An independent oracle: the physics engine DART carries the same body, with a 6x6 inertia that
// includes the added mass. Weight, buoyancy and thrust act there as forces at points, in DART's own
// frames, so that nothing but the parameters is shared.
#include <gtest/gtest.h>

#include "fixtures.hpp"

#ifdef KELPIE_HAVE_DART
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#endif

namespace kelpie::dart_test {
namespace {

#ifndef KELPIE_HAVE_DART

TEST(Dart, AgreesWithTheIntegrator) {
  GTEST_SKIP() << "built without the physics engine DART (libdart-dev)";
}

#else

constexpr double kDurationS = 4.0;

// DART orders six-vectors angular, linear.
simulator::Vector6 swapped(const simulator::Vector6& value) {
  return (simulator::Vector6() << value.tail<3>(), value.head<3>()).finished();
}

simulator::Matrix6 swapped(const simulator::Matrix6& m) {
  simulator::Matrix6 result;
  result << m.bottomRightCorner<3, 3>(), m.bottomLeftCorner<3, 3>(), m.topRightCorner<3, 3>(),
      m.topLeftCorner<3, 3>();
  return result;
}

void add_forces(dart::dynamics::BodyNode& body, const simulator::VehicleParameters& vehicle,
                const simulator::RotorSpeeds& speeds_rps) {
  const double weight = vehicle.mass_kg * simulator::kGravity;
  const Eigen::Vector3d down = Eigen::Vector3d::UnitZ();
  body.addExtForce(weight * down, vehicle.centre_of_gravity_m, false, true);
  body.addExtForce(-(weight + vehicle.net_buoyancy_n) * down, vehicle.centre_of_buoyancy_m, false,
                   true);
  for (std::size_t i = 0; i < vehicle.thrusters.size(); ++i) {
    const simulator::Thruster& thruster = vehicle.thrusters[i];
    const double n = speeds_rps(static_cast<Eigen::Index>(i));
    const double force = (n < 0.0 ? -thruster.reverse : thruster.forward) * n * n;
    body.addExtForce(force * thruster.direction, thruster.position_m, true, true);
  }
  const simulator::Vector6 velocity = swapped(body.getSpatialVelocity());
  const simulator::Vector6 drag = velocity.cwiseProduct(
      vehicle.linear_damping + vehicle.quadratic_damping.cwiseProduct(velocity.cwiseAbs()));
  body.addExtForce(-drag.head<3>(), Eigen::Vector3d::Zero(), true, true);
  body.addExtTorque(-drag.tail<3>(), true);
}

simulator::Vector6 dart_velocity(const simulator::VehicleParameters& vehicle,
                                 const simulator::State& start, double step_s) {
  const auto skeleton = dart::dynamics::Skeleton::create("vehicle");
  const auto [joint, body] = skeleton->createJointAndBodyNodePair<dart::dynamics::FreeJoint>();
  dart::dynamics::Inertia inertia;
  inertia.setSpatialTensor(swapped(testing::nominal(vehicle).mass));
  body->setInertia(inertia);
  skeleton->setGravity(Eigen::Vector3d::Zero());
  skeleton->setTimeStep(step_s);
  joint->setSpatialVelocity(swapped(start.velocity), dart::dynamics::Frame::World(), body);

  for (long step = std::lround(kDurationS / step_s); step > 0; --step) {
    add_forces(*body, vehicle, start.rotors_rps);
    skeleton->computeForwardDynamics();
    skeleton->integrateVelocities(step_s);
    skeleton->integratePositions(step_s);
    skeleton->clearExternalForces();
  }
  return swapped(body->getSpatialVelocity());
}

// DART's integrator is of first order: its difference to ours must be its own error, and fall
// tenfold with a tenth of the step.
TEST(Dart, AgreesWithTheIntegrator) {
  RandomStream stream(1, "dart");
  const simulator::VehicleParameters vehicle = testing::coupled_vehicle(stream);
  simulator::State start;
  start.velocity << 0.4, -0.2, 0.1, 0.3, -0.2, 0.5;
  start.rotors_rps.resize(5);
  start.rotors_rps << 12.0, -5.0, 8.0, 3.0, -2.0;
  const simulator::RotorDrive drive{.commands_rps = start.rotors_rps, .lag_s = 0.0};
  const simulator::Vector6 ours =
      testing::after(simulator::Dynamics(testing::nominal(vehicle)), start, kDurationS, 0.01, drive)
          .velocity;

  const double coarse = (dart_velocity(vehicle, start, 1e-2) - ours).norm();
  const double middle = (dart_velocity(vehicle, start, 1e-3) - ours).norm();
  const double fine = (dart_velocity(vehicle, start, 1e-4) - ours).norm();
  std::cout << "difference at steps of 1e-2, 1e-3, 1e-4 s: " << coarse << ", " << middle << ", "
            << fine << '\n';
  EXPECT_LT(coarse, 0.1);
  EXPECT_NEAR(coarse / middle, 10.0, 2.0);
  EXPECT_NEAR(middle / fine, 10.0, 1.0);
}

#endif

}  // namespace
}  // namespace kelpie::dart_test
