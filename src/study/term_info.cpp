// SPDX-License-Identifier: Apache-2.0
#include "study/term_info.hpp"

#include <cmath>
#include <optional>

#include "kelpie/motion/expression.hpp"

namespace kelpie::study {
namespace {

std::optional<Unit> unit_of(const log::Dataset& data, const std::string& column) {
  const auto found = data.units.find(column);
  return found == data.units.end() ? std::nullopt : std::optional(found->second);
}

// A value that isn't finite counts as 0, as it does in the model.
double root_mean_square(const Expression& term, const log::Dataset& data,
                        std::span<const std::size_t> rows) {
  double sum = 0.0;
  for (const std::size_t row : rows) {
    const double value = term(data.input(row));
    sum += std::isfinite(value) ? value * value : 0.0;
  }
  return std::sqrt(sum / static_cast<double>(rows.size()));
}

std::string coefficient_unit(const Expression& formula, const log::Dataset& data,
                             const std::string& target) {
  std::vector<std::optional<Unit>> input_units;
  input_units.reserve(data.input_names.size());
  for (const std::string& input : data.input_names) {
    input_units.push_back(unit_of(data, input));
  }
  const std::optional<Unit> target_unit = unit_of(data, target);
  const std::optional<Unit> unit = formula.unit(input_units);
  return unit && target_unit ? (*target_unit / *unit).text() : "";
}

}  // namespace

std::string unit_text(const log::Dataset& data, const std::string& column) {
  const std::optional<Unit> unit = unit_of(data, column);
  return unit ? unit->text() : "";
}

std::string coefficient_unit(const std::string& term, const log::Dataset& data,
                             const std::string& target) {
  return coefficient_unit(Expression::parse(term, data.input_names), data, target);
}

std::vector<TermInfo> describe_terms(const std::vector<Coefficient>& coefficients,
                                     const log::Dataset& data, const std::string& target,
                                     std::span<const std::size_t> rows) {
  std::vector<TermInfo> terms;
  for (const Coefficient& coefficient : coefficients) {
    const Expression formula = Expression::parse(coefficient.term, data.input_names);
    terms.push_back({coefficient.term, coefficient_unit(formula, data, target),
                     root_mean_square(formula, data, rows), coefficient.error});
  }
  return terms;
}

}  // namespace kelpie::study
