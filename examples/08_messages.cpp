// SPDX-License-Identifier: Apache-2.0
// 08: from messages to a model, live. Velocities and commands come as messages of their own, each
// with its stamp, some late, some not at all; accelerations don't come. A SampleStream makes
// samples of them: docs/howto/logs.md says how. `kelpie learn` would make the same of a bag.
//
// Prints:
//   u: 5950 samples, 20 messages left out as late, 1 silence, the longest 5.1 s
//   2969 samples learned, 36 rows incomplete
//   udot is foretold to within 0.008 m/s²; it varies by 0.111 m/s²

#include <array>
#include <cmath>
#include <cstdio>

#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/stream/sample_stream.hpp"
#include "toy_vehicle.hpp"

namespace {

kelpie::StreamPlan plan() {
  constexpr auto kHold = kelpie::Interpolation::hold;
  kelpie::StreamPlan plan;
  plan.sources = {{.name = "u"},  // a velocity lies on the line between two messages …
                  {.name = "r"},
                  {.name = "n1", .between = kHold},  // … a command holds until the next
                  {.name = "n2", .between = kHold}};
  plan.derived = {{.name = "udot", .of = "u"}, {.name = "rdot", .of = "r"}};
  plan.inputs = {"u", "r", "n1", "n2"};
  plan.targets = {"udot", "rdot"};
  // A centred window makes a row complete half a window later, which a learner can well wait for.
  plan.derivative = {.window = kelpie::FilterWindow::centred, .window_s = 0.8, .degree = 2};
  plan.rate_hz = 5.0;
  plan.wait_s = 0.3;
  return plan;
}

// Learns the rows that are complete, and tells how well they were foretold.
class Learner {
 public:
  Learner()
      : stream(plan()),
        model_(stream.plan().inputs, stream.plan().targets,
               kelpie::ModelSettings::from_preset("default", 2)) {}

  kelpie::SampleStream stream;

  void learn() {
    while (const auto* const row = stream.next()) {
      if (!row->is_whole) {
        ++incomplete_;
        continue;
      }
      std::array<double, 2> foretold{};
      model_.predict(row->x, foretold);
      if (++learned_ > 500) {
        missed_ += std::pow(row->y[0] - foretold[0], 2);
        squares_ += std::pow(row->y[0], 2);
      }
      model_.update(row->x, row->y, row->t);
    }
  }

  void show() const {
    const kelpie::SignalFaults& u = stream.signal(0).faults();
    std::printf("u: %zu samples, %zu messages left out as late, %zu silence, the longest %.1f s\n",
                u.samples, u.late, u.gaps, u.longest_gap_s);
    std::printf("%d samples learned, %d rows incomplete\n", learned_, incomplete_);
    std::printf("udot is foretold to within %.3f m/s²; it varies by %.3f m/s²\n",
                std::sqrt(missed_ / (learned_ - 500)), std::sqrt(squares_ / (learned_ - 500)));
  }

 private:
  kelpie::DynamicsModel model_;
  int learned_ = 0;
  int incomplete_ = 0;
  double missed_ = 0.0;
  double squares_ = 0.0;
};

}  // namespace

int main() {
  enum Source : std::size_t { kU, kR, kN1, kN2 };  // as in the plan
  ToyVehicle vehicle;
  Learner learner;
  kelpie::RandomStream noise(1, "velocity log");
  for (int i = 0; i < 6000; ++i) {
    const double t = vehicle.t();
    const auto [n1, n2] = ToyVehicle::pilot(t);
    learner.stream.feed(kN1, t, n1);
    learner.stream.feed(kN2, t, n2);
    learner.learn();
    const double u = vehicle.u() + 0.002 * noise.normal();
    const double r = vehicle.r() + 0.002 * noise.normal();
    vehicle.drive(n1, n2);
    // Once the velocities are gone for five seconds; now and then one comes that is long past.
    if (i < 3000 || i >= 3050) {
      learner.stream.feed(kU, t, u);
      learner.stream.feed(kR, t, r);
      learner.learn();
    }
    if (i % 300 == 299) {
      learner.stream.feed(kU, t - 5.05, u);
    }
  }
  learner.stream.finish();
  learner.learn();
  learner.show();
}
