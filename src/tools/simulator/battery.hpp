// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulator/dynamics.hpp"
#include "simulator/parameters.hpp"

namespace kelpie::simulator {

/// Electrical power of the thrusters at `factor` times the thrust at nominal voltage, W. A weakened
/// thruster (effectiveness below 1) draws as much as a sound one. Doesn't allocate.
double thruster_power_w(const VehicleParameters& vehicle, const RotorSpeeds& speeds_rps,
                        double factor);

/// A battery with internal resistance, whose voltage without load falls linearly with the charge
/// drawn. Without a battery (nominal_v 0) the voltage is 0 and the factor 1.
class Battery {
 public:
  /// Charged. Requires parameters that validate.
  explicit Battery(const BatteryParameters& parameters);

  /// Draws `power_w`, and the electronics' power, for `period_s`. At powers beyond the battery's
  /// greatest the voltage is half the voltage without load.
  void draw(double power_w, double period_s);

  double voltage_v() const { return voltage_v_; }
  double thrust_factor() const;  ///< (voltage / nominal)^exponent

 private:
  BatteryParameters parameters_;
  double drawn_as_ = 0.0;  ///< charge, A s
  double voltage_v_ = 0.0;
};

}  // namespace kelpie::simulator
