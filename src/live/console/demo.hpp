// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "live/configuration.hpp"

namespace kelpie::cli {

/// The configuration for replaying rows of the simulated vehicle Dagon for `duration_s` at 10 Hz,
/// with noise as recorded; in the second half th2 gives 60 % of its thrust. The drive is simulated
/// while the rows are replayed; equal durations give equal rows. Throws InputError (--duration) on
/// a duration that is no whole number of rows, and as live::rows_configuration() does.
live::Configuration demo_configuration(double duration_s, const std::filesystem::path& file,
                                       const std::vector<std::string>& set);

}  // namespace kelpie::cli
