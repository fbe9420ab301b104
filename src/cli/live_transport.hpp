// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "live/checkpoint.hpp"
#include "live/configuration.hpp"
#include "live/transport.hpp"
#include "log/read_log.hpp"

namespace kelpie::cli {

/// Where `kelpie live` gets its messages: from a recording where `from` names one, by MAVLink
/// where there is a table [live.mavlink], else from topics of ROS 2. A recording hurries through
/// what `saved` has learned of it. The configuration has to outlive it. Throws InputError, and
/// Failure, as these do, and where this kelpie was built without DDS.
std::unique_ptr<live::Transport> transport_of(const log::LogSource& from, const std::string& speed,
                                              const live::Configuration& configuration,
                                              const std::optional<live::SavedRun>& saved);

/// Whether both would connect to the same. Throws InputError as transport_of() does of a table.
bool connects_alike(const live::Configuration& now, const live::Configuration& next);

}  // namespace kelpie::cli
