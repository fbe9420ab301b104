// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace kelpie::log {

/// Columns of a regression, [column][row].
using ColumnList = std::vector<std::vector<double>>;

/// Columns with mean 0 and variance 1, of some rows; a constant column becomes 0.
Eigen::MatrixXd standardised(const ColumnList& columns, const std::vector<std::size_t>& rows);

/// v, v|v| and the products of the states.
ColumnList drag_terms(const ColumnList& states);

}  // namespace kelpie::log
