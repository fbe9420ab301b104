// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "live/health.hpp"

namespace kelpie::web {

/// A health in Prometheus' text format 0.0.4, with names of axes, signals, topics and thrusters as
/// labels.
std::string metrics_text(const live::Health& health);

}  // namespace kelpie::web
