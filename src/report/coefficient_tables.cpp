// SPDX-License-Identifier: Apache-2.0
#include "coefficient_tables.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kelpie/report/terms.hpp"
#include "kelpie/report/wording.hpp"

namespace kelpie {
namespace {

constexpr std::size_t kLongestFormula = 28;
constexpr std::size_t kLongestUnit = 20;

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

std::vector<TextTable> coefficient_tables(const StreamResult& result) {
  std::vector<TextTable> tables;
  for (const AxisResult& axis : result.axes) {
    if (axis.terms.empty()) {
      continue;
    }
    const std::string unit = axis.unit.empty() ? "" : " in " + axis.unit;
    TextTable table{
        axis.name + unit, {"term", "coefficient", "unit", "at half", "change", "effect"}, {}};
    for (const TermView& view : term_views(axis)) {
      table.rows.push_back({shortened(view.term.formula, kLongestFormula), significant(view.value),
                            shortened(or_dash(view.term.unit), kLongestUnit),
                            significant(view.at_half), change(view.at_half, view.value),
                            significant(view.effect)});
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace kelpie
