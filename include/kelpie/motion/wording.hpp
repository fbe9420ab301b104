// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "kelpie/motion/cause.hpp"

namespace kelpie {

/// Names of the columns that a diagnosis is of, in their order.
struct DiagnosisNames {
  std::span<const std::string> inputs;   ///< columns of x
  std::span<const std::string> targets;  ///< columns of y
};

std::string_view kind_name(CauseKind kind);       ///< "thruster", "sensor_scale", …
std::string_view state_name(FindingState state);  ///< "named", "ambiguous", …

/// The column that a cause is of: that of a thruster or a sensor, the target of a drag or a force;
/// empty of a load.
std::string cause_column(const Cause& cause, const DiagnosisNames& names);

/// "th2 gives 48 % of its thrust (41 to 55 %)".
std::string cause_text(const Cause& cause, const DiagnosisNames& names);

/// The same of all that a finding says: causes joined by "and"; which two can't be told apart and
/// what to drive; or that nothing known explains it.
std::string finding_text(const Finding& finding, const DiagnosisNames& names);

}  // namespace kelpie
