// SPDX-License-Identifier: Apache-2.0
#include "study/terms.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

#include "kelpie/motion/expression.hpp"

namespace kelpie::study {
namespace {

double at_or_nan(const std::vector<double>& values, std::size_t term) {
  return term < values.size() ? values[term] : kUnknown;
}

double mean_effect(const TermView& view) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const double value : view.values) {
    if (std::isfinite(value)) {
      sum += std::abs(value * view.term.rms);
      ++count;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

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

std::vector<TermView> term_views(const AxisResult& axis) {
  const std::vector<ValidationPoint>& points = axis.validation;
  std::vector<TermView> views;
  for (std::size_t k = 0; k < axis.terms.size(); ++k) {
    TermView view{axis.terms[k], kUnknown, kUnknown, kUnknown, {}, {}};
    for (const ValidationPoint& point : points) {
      view.value = at_or_nan(point.coefficients, k);
      if (2 * point.samples <= points.back().samples) {
        view.at_half = view.value;
      }
      view.values.push_back(view.value);
      view.errors.push_back(at_or_nan(point.errors, k));
    }
    view.effect = view.value * view.term.rms;
    views.push_back(std::move(view));
  }
  return views;
}

std::vector<TermView> most_effective(const std::vector<TermView>& views, std::size_t most) {
  std::vector<std::size_t> places(views.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::ranges::stable_sort(places, std::greater<>{},
                           [&](std::size_t k) { return mean_effect(views[k]); });
  places.resize(std::min(most, places.size()));
  std::ranges::sort(places);
  std::vector<TermView> chosen;
  chosen.reserve(places.size());
  for (const std::size_t k : places) {
    chosen.push_back(views[k]);
  }
  return chosen;
}

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
