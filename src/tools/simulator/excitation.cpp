// SPDX-License-Identifier: Apache-2.0
#include "simulator/excitation.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"
#include "simulator/tuning.hpp"

namespace kelpie::simulator {
namespace {

Oscillator oscillator(const ExcitationSettings& settings, std::uint64_t seed,
                      const std::string& name) {
  return {settings, RandomStream(seed, "excitation/" + name)};
}

// Two independent sines a, b of equal power mix to p a ± q b of correlation p² − q². Dividing by
// p + q keeps their greatest value at 1 without clipping, which would change the correlation.
Eigen::Matrix3d mixing(const ExcitationSettings& settings) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  if (settings.mode == ExcitationMode::correlated) {
    const double p = std::sqrt((1.0 + settings.correlation) / 2.0);
    const double q = std::sqrt((1.0 - settings.correlation) / 2.0);
    matrix.topLeftCorner<2, 2>() << p, q, p, -q;
    matrix.topRows<2>() /= p + q;
  }
  return matrix;
}

}  // namespace

ExcitationMode excitation_mode_from(const std::string& name) {
  const std::vector<std::string> names = {"independent", "correlated", "prbs", "steps", "pilot"};
  return static_cast<ExcitationMode>(require_name({}, name, "mode of excitation", names));
}

void ExcitationSettings::validate() const {
  require(std::isfinite(longest_period_s) && shortest_period_s >= kTuning.shortest_period_s &&
              shortest_period_s <= longest_period_s,
          "excitation.period_s",
          "must be [shortest, longest], both at least " + number_text(kTuning.shortest_period_s) +
              " s, shortest first");
  require(correlation >= -1.0 && correlation <= 1.0, "excitation.correlation",
          "must be between -1 and 1");
  require(
      effort.allFinite() && effort.minCoeff() >= 0.0 && (in_plane() || effort.maxCoeff() > 0.0),
      "excitation.effort",
      "must be six numbers of N and N m, none negative; prbs, steps and pilot need one above 0");
  require(dither >= 0.0 && dither <= 1.0, "excitation.dither", "must be between 0 and 1");
}

Oscillator::Oscillator(const ExcitationSettings& settings, RandomStream stream)
    : shortest_s_(settings.shortest_period_s),
      longest_s_(settings.longest_period_s),
      stream_(stream),
      period_s_(stream_.uniform(shortest_s_, longest_s_)) {}

double Oscillator::advance(double dt_s) {
  cycle_share_ += dt_s / period_s_;
  if (cycle_share_ >= 1.0) {
    // The rest of the step belongs to the new cycle, at the new cycle's speed.
    const double rest_s = (cycle_share_ - 1.0) * period_s_;
    period_s_ = stream_.uniform(shortest_s_, longest_s_);
    cycle_share_ = rest_s / period_s_;
  }
  return std::sin(2.0 * std::numbers::pi * cycle_share_);
}

Excitation::Excitation(const ExcitationSettings& settings, const Eigen::Vector3d& max_speeds_rps,
                       std::uint64_t seed)
    : oscillators_{oscillator(settings, seed, "surge_left"),
                   oscillator(settings, seed, "surge_right"), oscillator(settings, seed, "sway")},
      mixing_(max_speeds_rps.asDiagonal() * mixing(settings)) {}

Eigen::Vector3d Excitation::advance(double dt_s, double amplitude) {
  const Eigen::Vector3d sines(oscillators_[0].advance(dt_s), oscillators_[1].advance(dt_s),
                              oscillators_[2].advance(dt_s));
  return amplitude * (mixing_ * sines);
}

}  // namespace kelpie::simulator
