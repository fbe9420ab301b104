// SPDX-License-Identifier: Apache-2.0
// 04: dead reckoning. The velocity log fails for half a minute; a rollout of the learned model
// predicts the velocities from the commands alone, with their spread.
//
// Prints:
//     age   true u   reckoned   spread   [m/s]
//    10 s    0.532      0.532    0.065
//    20 s   -1.086     -1.088    0.065
//    30 s   -0.263     -0.263    0.054
//   way made good -4.88 m, reckoned -4.89 m: 0.01 m off

#include <array>
#include <cmath>
#include <cstdio>

#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/rollout.hpp"
#include "kelpie/model/trained_model.hpp"
#include "toy_vehicle.hpp"

int main() {
  kelpie::ModelSettings settings = kelpie::ModelSettings::from_preset("default", 2);
  settings.assign("buffer", "300");
  kelpie::DynamicsModel model({"u", "r", "n1", "n2"}, {"udot", "rdot"}, settings);
  ToyVehicle vehicle;
  for (int i = 0; i < 3000; ++i) {
    const auto [n1, n2] = ToyVehicle::pilot(vehicle.t());
    const std::array<double, 4> x = vehicle.inputs(n1, n2);
    model.update(x, vehicle.measure(x), vehicle.t());
    vehicle.drive(n1, n2);
  }

  // A rollout copies the present model; learning may continue meanwhile.
  kelpie::Rollout rollout(kelpie::open_loop(model.trained()));
  const auto [first_n1, first_n2] = ToyVehicle::pilot(vehicle.t());
  rollout.start(vehicle.inputs(first_n1, first_n2));
  double travelled = 0.0;
  double reckoned = 0.0;
  std::printf("  age   true u   reckoned   spread   [m/s]\n");
  for (int i = 1; i <= 300; ++i) {
    const auto [n1, n2] = ToyVehicle::pilot(vehicle.t());
    vehicle.drive(n1, n2);
    const auto [next_n1, next_n2] = ToyVehicle::pilot(vehicle.t());
    // The velocities among the inputs are ignored, since nothing measures them.
    rollout.advance(std::array{0.0, 0.0, next_n1, next_n2}, ToyVehicle::kStepS);
    travelled += vehicle.u() * ToyVehicle::kStepS;
    reckoned += rollout.velocity(0) * ToyVehicle::kStepS;
    if (i % 100 == 0) {
      std::printf("%3.0f s   %6.3f     %6.3f    %5.3f\n", rollout.age_s(), vehicle.u(),
                  rollout.velocity(0), rollout.spread(0));
    }
  }
  std::printf("way made good %.2f m, reckoned %.2f m: %.2f m off\n", travelled, reckoned,
              std::abs(travelled - reckoned));
}
