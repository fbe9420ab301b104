// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "kelpie/identify/planar_fit.hpp"
#include "live/configuration.hpp"
#include "live/health.hpp"
#include "live/output.hpp"
#include "study/identification.hpp"

namespace kelpie::live {

/// Parameters of the vehicle in the plane, identified while the vehicle drives, and how far each is
/// from the interval that is asked for (howto/live.md#parameters). Uses the rows since the start or
/// the last change of the vehicle; a checkpoint keeps none. For the learning thread.
class ParameterCountdown {
 public:
  /// Throws InputError where the rows have no velocities in the plane or no thrusters (for six axes
  /// with the way to identify these), and on a name in `thrust` that is no thruster.
  ParameterCountdown(const Configuration& configuration, const ParameterSettings& settings);

  /// Keeps an aligned row of inputs (half an hour of them), and identifies anew every 5 s of rows;
  /// events tell how many parameters are known, and when the least known one will be, by the
  /// information of the last minute. `changed`: the vehicle, so that older rows go.
  /// Cost: now and then fit_planar(). Allocates.
  void update(std::span<const double> x, double t, bool changed, Output& output);

  /// Fills in the parameters of `health`.
  void report(LearnerHealth& health) const;

 private:
  void begin_anew();
  void keep(std::span<const double> x, double t);
  void forget_oldest(std::size_t gone);
  std::size_t rows_in(double seconds) const;
  void identify(double t);
  double remaining_s(std::size_t place) const;
  std::size_t known() const;
  std::string text() const;

  // What was found at an earlier fit.
  struct Past {
    double t = 0.0;
    std::vector<ParameterHealth> found;
  };

  ParameterSettings settings_;
  study::PlanarColumns columns_;
  double rate_hz_;
  PlanarRows rows_;
  std::vector<ParameterHealth> found_;  // empty: nothing is told so far
  std::deque<Past> past_;               // of the last minute, the oldest first
  std::string reason_;                  // why
  double identified_s_;                 // time of the last fit
};

}  // namespace kelpie::live
