// SPDX-License-Identifier: Apache-2.0
// 13: from a fault to authority. The starboard thruster loses half its force; the diagnosis names
// the loss, the authority says what is left, and commands for a wanted acceleration straight ahead
// are allocated, by the authority of before and of after. With the commands of before [rev/s] the
// damaged vehicle is slow and turns.
//
// Prints:
//   found at 243 s: n2 gives 50.1 % of its thrust (49.7 to 50.5 %)
//   shares left: n1 1.00, n2 0.50
//   n2 gives 50 % of its thrust: surge 0.75, yaw 0.75 of nominal left,
//     holds a current of 1.24 m/s from ahead
//   wanted   allocated      n1    n2   expected [m/s², rad/s²]   missing   reached [m/s², rad/s²]
//   0.8, 0   before        6.31  6.33    0.80  0.00               0 %        0.59  0.19
//   0.8, 0   after         6.31  8.95    0.80  0.00               0 %        0.79 -0.01
//   2.0, 0   before        9.98 10.01    2.00  0.00               0 %        1.49  0.48
//   2.0, 0   after         9.97 12.00    1.72  0.28              10 %        1.70  0.26

#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "kelpie/vehicle/diagnosis.hpp"
#include "toy_vehicle.hpp"

namespace {

const std::vector<std::string> kInputs{"u", "r", "n1", "n2"};
const std::vector<std::string> kTargets{"udot", "rdot"};
const kelpie::DiagnosisNames kNames{kInputs, kTargets};

// Four minutes more, in which the starboard thruster gives a share of its thrust.
void drive(ToyVehicle& vehicle, kelpie::Diagnosis& diagnosis, double share) {
  for (int i = 0; i < 2400; ++i) {
    const auto [n1, n2] = ToyVehicle::pilot(vehicle.t());
    const double driven = ToyVehicle::weakened(n2, share);
    const std::array<double, 2> y = vehicle.measure(vehicle.inputs(n1, driven));
    diagnosis.update(vehicle.inputs(n1, n2), y, vehicle.t());
    vehicle.drive(n1, driven);
  }
}

// What the commands of an authority do to the damaged vehicle at rest; `reached` is what the
// authority expects.
void try_out(const char* when, const kelpie::Authority& authority, double surge) {
  const kelpie::Allocation allocation = authority.allocate(std::array{surge, 0.0});
  const double n1 = allocation.commands[0];
  const double n2 = allocation.commands[1];
  ToyVehicle at_rest;
  const auto [udot, rdot] = at_rest.measure({0.0, 0.0, n1, ToyVehicle::weakened(n2, 0.5)});
  std::printf(
      "%.1f, 0   %s       %5.2f %5.2f   %5.2f %5.2f              %2.0f %%       %5.2f %5.2f\n",
      surge, when, n1, n2, allocation.reached[0], allocation.reached[1], 100.0 * allocation.missing,
      udot, rdot);
}

}  // namespace

int main() {
  ToyVehicle vehicle;
  kelpie::Diagnosis diagnosis(4, {0, 1}, {0, 5});  // u and r; n1 and n2 are thrusters
  const std::vector<kelpie::CommandRange> ranges{{2, -12.0, 12.0}, {3, -12.0, 12.0}};
  drive(vehicle, diagnosis, 1.0);
  const kelpie::Authority before(diagnosis, ranges);
  drive(vehicle, diagnosis, 0.5);
  for (const kelpie::Finding& finding : diagnosis.findings()) {
    std::printf("found at %.0f s: %s\n", finding.found_s, finding_text(finding, kNames).c_str());
  }

  const kelpie::Authority after(diagnosis, ranges);
  std::printf("shares left: n1 %.2f, n2 %.2f\n", after.thrusters()[0].share,
              after.thrusters()[1].share);
  std::string words = after.text(kNames, "m/s");
  words.replace(words.find("; "), 2, ",\n  ");  // too long for one line here
  std::printf("%s\n", words.c_str());

  std::printf(
      "wanted   allocated      n1    n2   expected [m/s², rad/s²]   missing   reached [m/s², "
      "rad/s²]\n");
  for (const double surge : {0.8, 2.0}) {
    try_out("before", before, surge);
    try_out("after ", after, surge);
  }
}
