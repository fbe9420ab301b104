// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "kelpie/alignment/alignment.hpp"
#include "live/configuration.hpp"
#include "log/read_log.hpp"

namespace kelpie::live {

/// Alignment with a lag of `seconds`, in whole rows, and the actuators known beforehand. Throws
/// InputError (file, live.align) where the names of the inputs don't tell velocities from commands.
Alignment alignment_of(const Configuration& configuration, double seconds);

/// Rows kept for the search of an alignment: those of a whole recording, at most
/// Tuning::most_kept_rows, as in a log; LiveAlignment::kUsualKeep of a connection.
std::size_t rows_to_keep(const Configuration& configuration,
                         const std::optional<log::Reach>& recording);

}  // namespace kelpie::live
