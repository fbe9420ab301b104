// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "kelpie/core/archive.hpp"
#include "study/result.hpp"

namespace kelpie::study {

/// What a stream has found of one axis so far: looks, stages, changes, times of updates. Throws
/// InputError on lists that don't fit each other, the samples shown, or the number of terms.
void visit_so_far(Archive& archive, AxisResult& result, std::size_t shown, std::size_t terms);

}  // namespace kelpie::study
