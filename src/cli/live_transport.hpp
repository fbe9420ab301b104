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

/// The source of messages of `kelpie live`: the recording `from`, or else MAVLink with a table
/// [live.mavlink], or else topics of ROS 2. A recording skips at full speed the part that `saved`
/// has learned. Requires that the configuration outlives the transport. Throws InputError and
/// Failure of the transport, and InputError in a build without DDS.
std::unique_ptr<live::Transport> transport_of(const log::LogSource& from, const std::string& speed,
                                              const live::Configuration& configuration,
                                              const std::optional<live::SavedRun>& saved);

/// Whether both configurations connect to the same source. Throws InputError on a wrong table.
bool connects_alike(const live::Configuration& now, const live::Configuration& next);

}  // namespace kelpie::cli
