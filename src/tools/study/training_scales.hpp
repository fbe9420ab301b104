// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/core/scaling.hpp"
#include "kelpie/model/settings.hpp"
#include "kelpie/motion/term_set.hpp"
#include "log/dataset.hpp"

namespace kelpie::study {

/// The scaling of some rows of a log, for each target. Throws InputError, naming the column, on an
/// input that is constant in these rows or a combination of earlier inputs.
std::vector<AxisScaling> training_scales(const log::Dataset& data,
                                         std::span<const std::size_t> rows,
                                         const SharedSettings& settings);

}  // namespace kelpie::study
