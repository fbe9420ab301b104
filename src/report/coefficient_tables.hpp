// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "chart/text_table.hpp"
#include "study/result.hpp"

namespace kelpie::report {

/// One table per axis that has coefficients: term, coefficient, its unit, what it was at half of
/// the stream and by how much it changed since, and its effect. A note on their columns is with the
/// last.
std::vector<chart::TextTable> coefficient_tables(const study::StreamResult& result);

}  // namespace kelpie::report
