// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kelpie/alignment/alignment.hpp"
#include "log/dataset.hpp"
#include "study/split.hpp"

namespace kelpie::study {

/// The current that the training rows tell (find_current), with commands by `alignment`. Without a
/// column of the heading: still water and no reason.
CurrentResult choose_current(const log::Dataset& data, const Split& split,
                             const std::string& states, const Alignment& alignment);

/// Current::text(), or "still water", and the reason.
std::string current_text(const CurrentResult& found);

/// The log in velocities through the water, and accelerations against the water where the log has
/// targets; without the heading among the inputs. Unchanged in still water. Throws InputError on a
/// log without the velocities, and without the heading in some row.
log::Dataset through_water(log::Dataset data, const Current& current);

}  // namespace kelpie::study
