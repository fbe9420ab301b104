// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "kelpie/core/archive.hpp"
#include "study/result.hpp"

namespace kelpie::study {

/// Saves or loads the results of one axis so far (result_fields.hpp). Throws InputError on lists
/// that contradict each other, the shown samples, or the number of terms.
void visit_so_far(Archive& archive, AxisResult& result, std::size_t shown, std::size_t terms);

}  // namespace kelpie::study
