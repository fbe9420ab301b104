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

/// The scaling of some rows of a log, of one target after the other. Throws InputError naming the
/// column when an input is constant there or a combination of those before it.
std::vector<AxisScaling> training_scales(const log::Dataset& data,
                                         std::span<const std::size_t> rows,
                                         const SharedSettings& settings);

}  // namespace kelpie::study
