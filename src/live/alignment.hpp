// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "kelpie/model/alignment.hpp"
#include "live/configuration.hpp"
#include "log/read_log.hpp"

namespace kelpie::live {

/// The shift of so many seconds that a configuration asks for, in whole rows. Throws InputError
/// (file, live.align) where its inputs aren't known by name.
Alignment alignment_of(const Configuration& configuration, double seconds);

/// Rows in which a shift is looked for: of a recording all of them, up to a million, to look at as
/// at a log.
std::size_t rows_to_keep(const Configuration& configuration,
                         const std::optional<log::Reach>& recording);

/// "commands are taken 0.5 s later".
std::string shift_text(const Alignment& alignment);

}  // namespace kelpie::live
