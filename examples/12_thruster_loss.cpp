// SPDX-License-Identifier: Apache-2.0
// 12: a thruster loses half its thrust. What is left of each axis, and commands that give wanted
// accelerations in spite of the loss.
//
// Prints:
//   x

#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/motion/diagnosis.hpp"
#include "toy_vehicle.hpp"

int main() {
  const std::vector<std::string> inputs{"u", "r", "n1", "n2"};
  const std::vector<std::string> targets{"udot", "rdot"};
  kelpie::DynamicsModel model(inputs, targets, kelpie::ModelSettings::from_preset("default", 2));
  ToyVehicle vehicle;
  constexpr double kFull = 9.0;
  for (int i = 0; i < 6600; ++i) {
    const auto [n1, n2] = ToyVehicle::pilot(vehicle.t());
    const std::array<double, 4> x = vehicle.inputs(n1, n2);
    const double given = i < 6000 ? n2 : 0.70710678 * n2;  // thrust goes with the square
    model.update(x, vehicle.measure(vehicle.inputs(n1, given)), vehicle.t());
    vehicle.drive(n1, given);
  }

  const kelpie::Authority authority(*model.diagnosis(), {{2, -kFull, kFull}, {3, -kFull, kFull}});
  std::printf("%s\n", authority.text({inputs, targets}).c_str());
  const kelpie::Allocation allocation = authority.allocate(std::array{0.1, 0.0});
  std::printf("udot 0.1, rdot 0: n1 %.2f, n2 %.2f; missing %.3f\n", allocation.commands[0],
              allocation.commands[1], allocation.missing);
}
