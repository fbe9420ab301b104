// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "log/dataset.hpp"
#include "vehicle/simulation.hpp"

namespace kelpie::study {

/// The rows of a simulation as a log with the columns t, conf, u, v, r, th1, th2, th3, udot, vdot,
/// rdot, and the true accelerations udot_true, vdot_true, rdot_true.
log::Table log_table(std::span<const vehicle::LogRow> rows, const std::string& source);

}  // namespace kelpie::study
