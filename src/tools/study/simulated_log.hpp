// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "log/dataset.hpp"
#include "simulator/simulation.hpp"

namespace kelpie::study {

/// The rows of a simulation as a log with the columns t, conf, u, v, r, th1, th2, th3, udot, vdot,
/// rdot, and the true accelerations udot_true, vdot_true, rdot_true.
log::Table log_table(std::span<const simulator::LogRow> rows, const std::string& source);

/// The rows of a simulation of six axes: t, conf, u, v, w, p, q, r, phi, theta, psi, the commands
/// by the names of `vehicle`'s thrusters, voltage where the vehicle has a battery, udot, vdot,
/// wdot, pdot, qdot, rdot, and the true accelerations udot_true, … Names have units ("m1 [us]").
log::Table log_table(std::span<const simulator::SixAxisRow> rows,
                     const simulator::VehicleParameters& vehicle, const std::string& source);

}  // namespace kelpie::study
