// SPDX-License-Identifier: Apache-2.0
#include "kelpie/core/random.hpp"

#include <cmath>
#include <numbers>

#include "core/hash.hpp"

namespace kelpie {
namespace {

// SplitMix64's finaliser: neighbouring seeds must not give neighbouring engine states.
std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31U);
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view name)
    : engine_(mix(mix(seed + 0x9e3779b97f4a7c15ULL) ^ fnv1a(name))) {}

double RandomStream::uniform() {
  return static_cast<double>(engine_() >> 11U) * 0x1.0p-53;
}

double RandomStream::uniform(double low, double high) {
  return low + (high - low) * uniform();
}

double RandomStream::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_normal_;
  }
  // Box-Muller; 1 - uniform() lies in (0, 1], where the logarithm is finite.
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  const double angle = 2.0 * std::numbers::pi * uniform();
  spare_normal_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

std::uint64_t RandomStream::below(std::uint64_t n) {
  const std::uint64_t limit = UINT64_MAX - UINT64_MAX % n;
  std::uint64_t draw = engine_();
  while (draw >= limit) {
    draw = engine_();
  }
  return draw % n;
}

}  // namespace kelpie
