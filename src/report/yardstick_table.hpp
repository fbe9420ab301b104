// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "chart/text_table.hpp"
#include "study/result.hpp"

namespace kelpie::report {

/// What the simple predictors are.
inline constexpr std::string_view kYardstickNote =
    "Least squares: recursive, on physics terms (x and x|x| of every input, products and "
    "squares of velocities), robust, nothing forgotten. Mean: of the targets so far. Last value: "
    "the target "
    "one sample ago; one step ahead it is hard to beat, and it says nothing of what comes later.";

/// R² of the learned model beside that of simple predictors, with a note on what they are.
chart::TextTable yardstick_table(const study::StreamResult& result);

}  // namespace kelpie::report
