// SPDX-License-Identifier: Apache-2.0
#include "log/regression_columns.hpp"

#include <cmath>

namespace kelpie::log {

Eigen::MatrixXd standardised(const ColumnList& columns, const std::vector<std::size_t>& rows) {
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(rows.size()),
                         static_cast<Eigen::Index>(columns.size()));
  for (Eigen::Index c = 0; c < matrix.cols(); ++c) {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      matrix(i, c) = columns[static_cast<std::size_t>(c)][rows[static_cast<std::size_t>(i)]];
    }
    matrix.col(c).array() -= matrix.col(c).mean();
    const double sigma = std::sqrt(matrix.col(c).squaredNorm() / static_cast<double>(rows.size()));
    matrix.col(c) /= sigma > 0.0 ? sigma : 1.0;
  }
  return matrix;
}

ColumnList drag_terms(const ColumnList& states) {
  ColumnList terms;
  const auto add = [&](auto term) {
    std::vector<double>& column = terms.emplace_back();
    column.reserve(states.front().size());
    for (std::size_t row = 0; row < states.front().size(); ++row) {
      column.push_back(term(row));
    }
  };
  for (std::size_t i = 0; i < states.size(); ++i) {
    add([&](std::size_t row) { return states[i][row]; });
    add([&](std::size_t row) { return states[i][row] * std::abs(states[i][row]); });
    for (std::size_t j = 0; j < i; ++j) {
      add([&](std::size_t row) { return states[i][row] * states[j][row]; });
    }
  }
  return terms;
}

}  // namespace kelpie::log
