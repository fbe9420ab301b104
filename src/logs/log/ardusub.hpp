// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kelpie::log {

/// An output of ArduPilot that drives a motor. A pulse above 1500 µs times `direction` pushes as
/// the frame's table says (AP_Motors6DOF.cpp: the direction is applied before the pulse is made).
struct MotorActuator {
  std::size_t output = 0;  ///< as in servo3_raw and C3
  std::size_t motor = 0;   ///< 1 to 12
  double direction = 1.0;  ///< MOT_n_DIRECTION: 1, or −1 for a reversed motor
};

/// ArduPilot's parameters by name, as the autopilot tells them.
using ParameterMap = std::map<std::string, double>;

/// The outputs that are motors by SERVOn_FUNCTION, in the order of the motors' numbers; empty: the
/// parameters name no motor.
std::vector<MotorActuator> motor_outputs(const ParameterMap& parameters);

/// The number of an output by its column: 3 of "SERVO_OUTPUT_RAW:servo3_raw", of
/// "/mavlink/1/1/SERVO_OUTPUT_RAW:servo3_raw" and of "RCOU:C3"; 0: the column is no output.
std::size_t output_of(std::string_view column);

/// The factor of an output's pulse about kNeutralPulseUs, as far as parameters tell: 1, or −1 for a
/// motor with MOT_n_DIRECTION −1. Empty: SERVOn_FUNCTION, or the direction of a motor, is unknown.
std::optional<double> pulse_factor(const ParameterMap& parameters, std::size_t output);

/// The pulse with that factor.
double mirrored(double pulse_us, double factor);

/// Names of the parameters that pulse_factor() needs next; empty: none.
std::string next_parameter(const ParameterMap& parameters, std::size_t output);

/// Outputs with another use, for the user: "12 (RC input 10), 16 (camera tilt)"; or "".
std::string other_outputs_text(const ParameterMap& parameters);

/// Name of ArduSub's FRAME_CONFIG: "vectored, 6 motors"; "": no ArduSub, or an unknown frame.
std::string sub_frame_name(const ParameterMap& parameters);

}  // namespace kelpie::log
