// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "live/checkpoint.hpp"
#include "live/configuration.hpp"
#include "live/output.hpp"
#include "live/requests.hpp"
#include "live/transport.hpp"
#include "log/read_log.hpp"

namespace kelpie::cli {

/// Source of messages for `kelpie live`: the rows of the configuration, else the recording `from`,
/// else MAVLink with a table [live.mavlink], else topics of ROS 2. A recording plays rows that
/// `saved` has learned without pauses. Requires that the configuration outlives the transport.
/// Throws as the transports do, and InputError in a build without DDS.
std::unique_ptr<live::Transport> transport_of(const log::LogSource& from, const std::string& speed,
                                              const live::Configuration& configuration,
                                              const std::optional<live::SavedRun>& saved);

/// Whether both configurations connect alike. Throws InputError as transport_of() does.
bool connects_alike(const live::Configuration& now, const live::Configuration& next);

bool has_pages();  ///< Whether this build has a page.

/// The page of a configuration, listening, with its address printed; null without `live.page`.
/// Requires that both outlive the page. Throws InputError (live.page).
std::unique_ptr<live::Output> page_of(const live::Configuration& configuration,
                                      live::Requests& requests);

}  // namespace kelpie::cli
