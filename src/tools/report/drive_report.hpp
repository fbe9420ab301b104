// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "format/drive_files.hpp"

namespace kelpie::report {

/// What the drive tells in some ten lines: the widest intervals now and after, duration, bounds.
std::string drive_verdict(const format::PlannedDrive& drive);

/// For a terminal: every number now and after, and the manoeuvres with the countdown.
std::string drive_tables(const format::PlannedDrive& drive);

/// One page: the countdown and the track as figures, and the tables.
std::string drive_html(const format::PlannedDrive& drive);

}  // namespace kelpie::report
