// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "live/health.hpp"

namespace kelpie::web {

/// The same in Prometheus' text format, version 0.0.4: every name with its meaning and unit, names
/// of axes, signals and topics as labels.
std::string metrics_text(const live::Health& health);

}  // namespace kelpie::web
