// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "chart/text_table.hpp"
#include "study/result.hpp"

namespace kelpie::report {

/// R² of the learned model beside that of simple predictors, with a note on what they are.
chart::TextTable yardstick_table(const study::StreamResult& result);

}  // namespace kelpie::report
