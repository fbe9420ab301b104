// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "kelpie/core/archive.hpp"
#include "kelpie/motion/cause.hpp"

namespace kelpie {

inline constexpr double kReach90 = 1.6448536269514722;  // standard errors, of an interval of 0.9

void visit_cause(Archive& archive, Cause& cause);
void visit_finding(Archive& archive, Finding& finding);

}  // namespace kelpie
