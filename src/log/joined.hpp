// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "log/dataset.hpp"

namespace kelpie::log {

/// Several logs of one vehicle as one, in their order. A log whose clock doesn't begin after the
/// end of the one before begins a minute after it. Requires one or more. Throws InputError naming
/// the log whose inputs, targets or rate (by more than a tenth) are others than the first one's, or
/// that alone has a column of held-out rows.
Dataset joined(std::vector<Dataset> logs);

}  // namespace kelpie::log
