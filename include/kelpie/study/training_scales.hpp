// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/core/scaling.hpp"
#include "kelpie/data/dataset.hpp"

namespace kelpie {

/// The scaling of some rows of a log, of one target after the other. Throws InputError naming the
/// column when an input is constant there or a combination of those before it.
std::vector<AxisScaling> training_scales(const Dataset& data, std::span<const std::size_t> rows,
                                         ScalingKind kind);

}  // namespace kelpie
