// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <set>
#include <string>

#include "log/ardusub.hpp"

namespace kelpie::autopilot {

/// What a vehicle with ArduSub says of itself.
struct HeardVehicle {
  log::ParameterMap parameters{};    ///< of outputs 1 to 16, as far as told
  std::set<std::string> messages{};  ///< names
};

/// Waits for an autopilot at a connection ("udp:14550"), asks for parameters and messages, until
/// motors, attitude, pulses and LOCAL_POSITION_NED are known, at most Tuning::longest_introduction,
/// and as long as `keep_going`, which is told the present fault of the link. Throws InputError
/// (--mavlink) on an invalid connection.
HeardVehicle hear_vehicle(const std::string& connection,
                          const std::function<bool(const std::string& fault)>& keep_going);

/// The configuration for the vehicle as TOML: six axes, the motors by their numbers, rows while the
/// motors are armed. Throws InputError (--mavlink) where the vehicle told no motor, no attitude or
/// no velocity.
std::string configuration_text(const std::string& connection, const HeardVehicle& heard);

}  // namespace kelpie::autopilot
