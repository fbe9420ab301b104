// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"

namespace kelpie::testing {

/// A vehicle in the plane, driven by n (ahead) and m (turning), moved by Euler's method (2 ms):
///
///     u' = n|n| − 0.5 u − 0.8 u|u| + v r,   v' = −0.9 v − u r,   r' = 0.6 m − 0.7 r
class PoseLog {
 public:
  struct Sample {
    double t = 0.0;
    double n = 0.0, m = 0.0;
    double u = 0.0, v = 0.0, r = 0.0;
    double udot = 0.0, vdot = 0.0, rdot = 0.0;
    double x = 0.0, y = 0.0, psi = 0.0;
  };

  explicit PoseLog(double duration_s, double rate_hz = 10.0) {
    constexpr double kStep = 2e-3;
    const auto every = std::lround(1.0 / (rate_hz * kStep));
    Sample now;
    for (long k = 0; kStep * static_cast<double>(k) < duration_s; ++k) {
      now.t = kStep * static_cast<double>(k);
      const auto phase = static_cast<std::uint64_t>(now.t / 4.0);
      now.n = wish(2 * phase);
      now.m = wish(2 * phase + 1);
      now.udot =
          now.n * std::abs(now.n) - 0.5 * now.u - 0.8 * now.u * std::abs(now.u) + now.v * now.r;
      now.vdot = -0.9 * now.v - now.u * now.r;
      now.rdot = 0.6 * now.m - 0.7 * now.r;
      if (k % every == 0) {
        samples.push_back(now);
      }
      now.x += kStep * (now.u * std::cos(now.psi) - now.v * std::sin(now.psi));
      now.y += kStep * (now.u * std::sin(now.psi) + now.v * std::cos(now.psi));
      now.psi += kStep * now.r;
      now.u += kStep * now.udot;
      now.v += kStep * now.vdot;
      now.r += kStep * now.rdot;
    }
  }

  /// "t,x,y,psi,n,m" with white noise on positions; the world turned by `turn`, psi within ±π.
  std::string csv(double noise_m, double turn = 0.0) const {
    RandomStream random(5, "pose");
    std::string text = "t,x,y,psi,n,m\n";
    for (const Sample& one : samples) {
      const double x = one.x + noise_m * random.normal();
      const double y = one.y + noise_m * random.normal();
      for (const double value :
           {one.t, std::cos(turn) * x - std::sin(turn) * y, std::sin(turn) * x + std::cos(turn) * y,
            std::remainder(one.psi + turn, 2.0 * 3.14159265358979323846), one.n, one.m}) {
        text += fmt::format("{:.9g},", value);
      }
      text.back() = '\n';
    }
    return text;
  }

  std::vector<Sample> samples;

 private:
  static double wish(std::uint64_t k) { return RandomStream(k, "wish").uniform(-1.0, 1.0); }
};

}  // namespace kelpie::testing
