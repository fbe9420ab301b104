// SPDX-License-Identifier: Apache-2.0
// 02: a vehicle's accelerations from its velocities and commands, in the units of your log. The
// model finds the scale of the data by itself. Every prediction comes with an interval, which holds
// the truth in nine of ten cases by default, and with a novelty: how far it is from known data.
//
// Prints:
//   90 % of 2990 accelerations were in their interval
//   where it is: udot -0.085 m/s², between -0.103 and -0.067, novelty 0.04
//   far away   : udot -2.411 m/s², between -2.429 and -2.394, novelty 1.00

#include <array>
#include <cstdio>

#include "kelpie/model/dynamics_model.hpp"
#include "toy_vehicle.hpp"

namespace {

void show(const char* where, const kelpie::DynamicsModel& model, const std::array<double, 4>& x) {
  std::array<kelpie::Prediction, 2> y;  // udot, rdot
  model.predict(x, y);                  // allocates nothing
  std::printf("%s: udot %.3f m/s², between %.3f and %.3f, novelty %.2f\n", where, y[0].value,
              y[0].lower, y[0].upper, y[0].novelty);
}

}  // namespace

int main() {
  // The names "u" and "r" tell the model that these are velocities.
  kelpie::ModelSettings settings = kelpie::ModelSettings::from_preset("default", 2);
  settings.assign("buffer", "300");
  kelpie::DynamicsModel model({"u", "r", "n1", "n2"}, {"udot", "rdot"}, settings);

  ToyVehicle vehicle;
  int judged = 0;
  int within = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto [n1, n2] = ToyVehicle::pilot(vehicle.t());
    const std::array<double, 4> x = vehicle.inputs(n1, n2);
    const std::array<double, 2> y = vehicle.measure(x);
    if (model.ready()) {
      std::array<kelpie::Prediction, 2> predicted;
      model.predict(x, predicted);
      ++judged;
      within += predicted[0].lower <= y[0] && y[0] <= predicted[0].upper ? 1 : 0;
    }
    model.update(x, y, vehicle.t());
    vehicle.drive(n1, n2);
  }

  std::printf("%.0f %% of %d accelerations were in their interval\n", 100.0 * within / judged,
              judged);
  const auto [n1, n2] = ToyVehicle::pilot(vehicle.t());
  show("where it is", model, vehicle.inputs(n1, n2));
  show("far away   ", model, {3.0, -2.0, 15.0, -15.0});
}
