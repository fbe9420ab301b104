// SPDX-License-Identifier: Apache-2.0
// 03: a controller at 50 Hz that follows a speed with a learned model, while another thread keeps
// teaching the model. At every step it linearises the model at the vehicle's state and solves for
// the commands that give the wanted acceleration,
//
//     f(x) + ∂f/∂n δn = a_wanted,
//
// One prediction with its Jacobian per step; it allocates nothing and waits for nobody.
//
// Prints:
//   speed followed to 0.0019 m/s (root mean square), yaw rate at the end -0.000 rad/s
//   1 picture of the model or more while it drove, none passed over

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>

#include "kelpie/model/shared_model.hpp"
#include "toy_vehicle.hpp"

namespace {

constexpr double kMostRevolutions = 9.0;  // rev/s

using Commands = std::array<double, 2>;

struct Sample {
  std::array<double, 4> x;
  std::array<double, 2> y;
  double t;
};

// Samples on their way to the learner. Your middleware has such a queue.
class Queue {
 public:
  void put(std::optional<Sample> sample) {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(sample);
    filled_.notify_one();
  }
  std::optional<Sample> take() {
    std::unique_lock lock(mutex_);
    filled_.wait(lock, [this] { return !waiting_.empty(); });
    const std::optional<Sample> sample = waiting_.front();
    waiting_.pop_front();
    return sample;
  }

 private:
  std::mutex mutex_;
  std::condition_variable filled_;
  std::deque<std::optional<Sample>> waiting_;
};

kelpie::DynamicsModel learned_from_a_pilot(ToyVehicle& vehicle) {
  kelpie::ModelSettings settings = kelpie::ModelSettings::from_preset("default", 2);
  settings.assign("buffer", "300");
  settings.assign("fine", "0");  // smoother derivatives: docs/howto/controller.md
  kelpie::DynamicsModel model({"u", "r", "n1", "n2"}, {"udot", "rdot"}, settings);
  for (int i = 0; i < 2000; ++i) {
    const auto [n1, n2] = ToyVehicle::pilot(vehicle.t());
    const std::array<double, 4> x = vehicle.inputs(n1, n2);
    model.update(x, vehicle.measure(x), vehicle.t());
    vehicle.drive(n1, n2);
  }
  return model;
}

Commands next_commands(const kelpie::SharedModel& model, const std::array<double, 4>& x,
                       const Eigen::Vector2d& wanted) {
  constexpr double kDamping = 1e-4;  // a thruster at rest has derivative 0
  std::array<double, 2> y;
  std::array<double, 8> jacobian;
  model.predict_with_jacobian(x, y, jacobian);
  Eigen::Matrix2d by_commands;
  by_commands << jacobian[2], jacobian[3], jacobian[6], jacobian[7];
  const Eigen::Vector2d missing = wanted - Eigen::Vector2d(y[0], y[1]);
  const Eigen::Matrix2d normal =
      by_commands.transpose() * by_commands + kDamping * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d change = normal.ldlt().solve(by_commands.transpose() * missing);
  return {std::clamp(x[2] + change[0], -kMostRevolutions, kMostRevolutions),
          std::clamp(x[3] + change[1], -kMostRevolutions, kMostRevolutions)};
}

}  // namespace

int main() {
  using namespace std::chrono_literals;
  ToyVehicle vehicle;
  kelpie::SharedModel model(learned_from_a_pilot(vehicle));
  Queue samples;
  std::thread learner([&] {
    while (const std::optional<Sample> sample = samples.take()) {
      model.update(sample->x, sample->y, sample->t);
    }
  });

  Commands n{5.0, 5.0};
  double squares = 0.0;
  int judged = 0;
  std::array<double, 2> y;
  const std::int64_t first = model.predict(vehicle.inputs(0.0, 0.0), y);
  auto wake = std::chrono::steady_clock::now();
  for (int i = 0; i < 400; ++i) {
    const double phase = 0.2 * ToyVehicle::kStepS * i;
    const double speed = 0.6 + 0.2 * std::sin(phase);  // the speed to follow, without turning
    const double acceleration = 0.2 * 0.2 * std::cos(phase);
    const Eigen::Vector2d wanted(acceleration + 1.0 * (speed - vehicle.u()), -1.0 * vehicle.r());
    n = next_commands(model, vehicle.inputs(n[0], n[1]), wanted);
    const std::array<double, 4> x = vehicle.inputs(n[0], n[1]);
    samples.put(Sample{x, vehicle.measure(x), vehicle.t()});
    vehicle.drive(n[0], n[1]);
    if (i >= 100) {  // by then it has caught up
      squares += (speed - vehicle.u()) * (speed - vehicle.u());
      ++judged;
    }
    std::this_thread::sleep_until(wake += 20ms);
  }
  samples.put(std::nullopt);
  learner.join();
  const std::int64_t last = model.predict(vehicle.inputs(0.0, 0.0), y);
  std::printf("speed followed to %.4f m/s (root mean square), yaw rate at the end %.3f rad/s\n",
              std::sqrt(squares / judged), vehicle.r());
  std::printf("%d picture of the model or more while it drove, %s passed over\n",
              last > first ? 1 : 0, model.passed_over() == 0 ? "none" : "some");
}
