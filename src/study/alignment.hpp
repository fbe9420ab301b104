// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kelpie/model/alignment_search.hpp"
#include "log/dataset.hpp"
#include "study/split.hpp"

namespace kelpie::study {

/// The shift a user asks for: "auto" looks for it on the training rows (find_alignment), "none", or
/// a number of seconds. `states` is the setting of this name.
/// Throws InputError (`--align`) on anything else, seconds beyond Alignment::kMostS, or seconds
/// where no input is known to be a velocity; as find_alignment does.
AlignmentFound choose_alignment(const log::Dataset& data, const Split& split,
                                const std::string& states, const std::string& wish);

/// The shift of an earlier model at this rate; `file` is where it stands.
AlignmentFound alignment_at(const Alignment& alignment, double rate_hz, const std::string& file);

/// The log with the commands that belong to each row; within stretches without a gap in time or a
/// change of configuration (AlignedRows). Times, targets and velocities stay where they are.
/// Requires a rate where there is a shift. Throws InputError on a command that is no input.
log::Dataset aligned(log::Dataset data, const Alignment& alignment);

/// "commands are taken 0.5 s (2 rows) later".
std::string shift_text(const Alignment& alignment, double rate_hz);

/// The same with the reason.
std::string alignment_text(const AlignmentFound& found, double rate_hz);

}  // namespace kelpie::study
