// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/alignment_rows.hpp"

#include <algorithm>
#include <cmath>

#include "kelpie/core/error.hpp"
#include "kelpie/core/quantile.hpp"

namespace kelpie {
namespace {

// A column of the rows in use, clipped to the range of most of them widened by its half on either
// side, and divided by the largest value left.
std::vector<double> tidy_column(std::span<const double> all, std::size_t column, std::size_t width,
                                std::span<const std::size_t> rows) {
  std::vector<double> values;
  values.reserve(rows.size());
  for (const std::size_t row : rows) {
    values.push_back(all[row * width + column]);
  }
  std::vector<double> order = values;
  const double low = quantile(order, 0.01);
  const double high = quantile(order, 0.99);
  const double margin = 0.5 * high - 0.5 * low;
  double largest = 0.0;
  for (double& value : values) {
    value = margin > 0.0 ? std::clamp(value, low - margin, high + margin) : value;
    largest = std::max(largest, std::abs(value));
  }
  std::ranges::for_each(values, [&](double& value) { value /= largest > 0.0 ? largest : 1.0; });
  return values;
}

bool breaks(const AlignmentProblem& problem, std::size_t before, std::size_t after) {
  return static_cast<double>(after - before) > AlignedRows::kLongestStep ||
         problem.times_s[after] - problem.times_s[before] >
             AlignedRows::kLongestStep / problem.rate_hz ||
         (!problem.configurations.empty() &&
          problem.configurations[after] != problem.configurations[before]);
}

}  // namespace

AlignmentRows::AlignmentRows(const AlignmentProblem& problem) : rows_(problem.rows) {
  if (!(problem.rate_hz > 0.0)) {
    throw InputError("rate", "has to be > 0 rows per second");
  }
  const std::size_t width = problem.input_names.size();
  for (std::size_t i = 0; i < width; ++i) {
    inputs.push_back(tidy_column(problem.inputs, i, width, rows_));
  }
  for (std::size_t i = 0; i < problem.target_count; ++i) {
    targets.push_back(tidy_column(problem.targets, i, problem.target_count, rows_));
  }
  first_.resize(size());
  last_.resize(size());
  for (std::size_t i = 1; i < size(); ++i) {
    first_[i] = breaks(problem, rows_[i - 1], rows_[i]) ? i : first_[i - 1];
  }
  for (std::size_t i = size(); i-- > 0;) {
    last_[i] = i + 1 == size() || first_[i + 1] == i + 1 ? i : last_[i + 1];
  }
}

std::size_t AlignmentRows::shifted(std::size_t i, int shift) const {
  const auto wanted = static_cast<std::ptrdiff_t>(rows_[i]) + shift;
  std::size_t at = i;
  if (shift > 0) {
    while (at < last_[i] && static_cast<std::ptrdiff_t>(rows_[at]) < wanted) {
      ++at;
    }
  } else {
    while (at > first_[i] && static_cast<std::ptrdiff_t>(rows_[at]) > wanted) {
      --at;
    }
  }
  return at;
}

}  // namespace kelpie
