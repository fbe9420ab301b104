// SPDX-License-Identifier: Apache-2.0
#include "report/coefficient_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "chart/wording.hpp"
#include "study/terms.hpp"

namespace kelpie::report {
namespace {

constexpr std::size_t kLongestFormula = 28;
constexpr std::size_t kLongestUnit = 20;
constexpr std::size_t kMostShownTerms = 12;
constexpr std::string_view kNote =
    "The terms with the largest effects; all are in result.json. ±: standard error. Change: since "
    "half of the stream. Effect: coefficient times the term's root mean square over "
    "the training rows, in the target's unit. What the kernel explains beside the terms is in none "
    "of these numbers.";

std::string or_dash(const std::string& text) {
  return text.empty() ? "–" : text;
}

// Of the coefficient's size, so that a thruster that loses effect is negative whatever its sign. A
// percentage says something as long as the coefficient was about as large before.
std::string change(double before, double after) {
  const double percent = 100.0 * (after / before - 1.0);
  if (!std::isfinite(percent)) {
    return "–";
  }
  if (before * after < 0.0) {
    return "sign";
  }
  if (std::abs(percent) >= 999.5) {
    return ">999 %";
  }
  const bool none = std::abs(percent) < 0.5;
  return fmt::format("{}{:.0f} %", none ? "±" : percent > 0.0 ? "+" : "−", std::abs(percent));
}

}  // namespace

std::vector<chart::TextTable> coefficient_tables(const study::StreamResult& result) {
  std::vector<chart::TextTable> tables;
  for (const study::AxisResult& axis : result.axes) {
    if (axis.terms.empty()) {
      continue;
    }
    const std::string unit = axis.unit.empty() ? "" : " in " + axis.unit;
    chart::TextTable table{
        axis.name + unit, {"term", "coefficient", "±", "unit", "at half", "change", "effect"}, {}};
    for (const study::TermView& view :
         study::most_effective(study::term_views(axis), kMostShownTerms)) {
      table.rows.push_back({chart::shortened(view.term.formula, kLongestFormula),
                            chart::significant(view.value), chart::significant(view.term.error),
                            chart::shortened(or_dash(view.term.unit), kLongestUnit),
                            chart::significant(view.at_half), change(view.at_half, view.value),
                            chart::significant(view.effect)});
    }
    tables.push_back(std::move(table));
  }
  if (!tables.empty()) {
    tables.back().notes.emplace_back(kNote);
  }
  return tables;
}

}  // namespace kelpie::report
