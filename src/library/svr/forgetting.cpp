// SPDX-License-Identifier: Apache-2.0
#include "svr/forgetting.hpp"

#include <algorithm>
#include <cmath>

namespace kelpie {

Forgetting::Forgetting(const OnlineSvrSettings& settings)
    : rule_(settings.forget),
      k_(settings.k),
      size_(static_cast<std::size_t>(settings.buffer)),
      anchors_(static_cast<std::size_t>(settings.anchors)) {}

std::optional<std::size_t> Forgetting::released(const SampleCollector& buffer) const {
  std::size_t idle = 0;
  std::size_t densest = 0;
  for (std::size_t i = 0; i < buffer.size(); ++i) {
    if (weightless(buffer, i)) {
      if (idle == 0 || buffer.density().at(i) > buffer.density().at(densest)) {
        densest = i;
      }
      ++idle;
    }
  }
  return idle > anchors_ ? std::optional(densest) : std::nullopt;
}

std::optional<std::size_t> Forgetting::forgotten(const SampleCollector& buffer, double now) const {
  if (buffer.size() <= size_) {
    return std::nullopt;
  }
  std::size_t worst = 0;
  double highest = score(buffer, 0, now);
  for (std::size_t i = 1; i < buffer.size(); ++i) {
    if (const double phi = score(buffer, i, now); phi > highest) {
      highest = phi;
      worst = i;
    }
  }
  return worst;
}

double Forgetting::score(const SampleCollector& buffer, std::size_t i, double now) const {
  switch (rule_) {
    case ForgetRule::fifo:
      return -static_cast<double>(buffer.arrivals()[i]);
    case ForgetRule::paper:  // eq. (7); a time before 0 has no root
      return buffer.density().at(i) / (std::sqrt(std::max(buffer.time(i), 0.0)) + k_);
    case ForgetRule::age:  // the same trade on the age, so that the clock's zero plays no part
      return buffer.density().at(i) * (std::sqrt(std::max(now - buffer.time(i), 0.0)) + k_);
  }
  return 0.0;
}

}  // namespace kelpie
