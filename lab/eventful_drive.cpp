// SPDX-License-Identifier: Apache-2.0
#include "lab/eventful_drive.hpp"

#include <algorithm>
#include <cmath>

namespace kelpie::lab {
namespace {

constexpr double kGrowth = 2.6;  // above the ratio at which scales are taken anew

double square(double value) {
  return value * std::abs(value);
}

}  // namespace

EventfulDrive::EventfulDrive(std::size_t samples, std::size_t events, std::uint64_t seed)
    : random_(seed, "eventful drive"),
      every_(std::max<std::size_t>(1, samples / (2 * events + 1))),
      most_events_(2 * events) {
  for (double& phase : phase_) {
    phase = random_.uniform(0.0, 6.0);
  }
  size_.fill(1.4);
}

void EventfulDrive::next() {
  if (sample_ > 0 && sample_ % every_ == 0 && sample_ / every_ <= most_events_) {
    happen(sample_ / every_);
  }
  ++sample_;
  for (std::size_t k = 0; k < kInputs; ++k) {
    phase_[k] += random_.uniform(0.02, 0.2);
    x_[k] = size_[k] * std::sin(phase_[k]);
  }
  const auto& [u, v, r, surge, sway, yaw] = x_;
  const double thrust = vehicle_ == 1 ? 0.5 : 1.0;
  const double side = vehicle_ == 2 ? -1.0 : 1.0;
  y_ = {thrust * surge - 0.5 * square(u) - 0.3 * u + 0.4 * v * r,
        side * sway - 0.8 * square(v) - 0.4 * u * r + 0.2 * std::sin(v),
        thrust * yaw - 0.4 * square(r) + side * 0.3 * square(surge) - 0.2 * r};
  for (double& acceleration : y_) {
    acceleration += (0.05 + 0.015 * std::abs(acceleration)) * random_.normal();
  }
}

void EventfulDrive::happen(std::size_t event) {
  if (event % 2 == 1) {
    vehicle_ = (vehicle_ + 1) % 3;
  } else {
    size_[(event / 2) % kInputs] *= kGrowth;
  }
}

}  // namespace kelpie::lab
