// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <ranges>
#include <string_view>

#include "format/c_terms.hpp"

namespace kelpie::format {
namespace {

struct Helper {
  std::string_view name;
  std::string_view code;
};

// Slopes at kinks are those of Expression::slope, to the right.
constexpr std::array kHelpers = std::to_array<Helper>({
    {"$NAME_finite", R"(
/* A term that isn't finite, or whose slope isn't, counts 0. */
static $REAL $NAME_finite($REAL term, $REAL result)
{
  return isfinite(term) && isfinite(result) ? result : 0;
}
)"},
    {"$NAME_abs", R"(
static $REAL $NAME_abs($REAL a)
{
  return a < 0 ? -a : a;
}
)"},
    {"$NAME_sign", R"(
static $REAL $NAME_sign($REAL a)
{
  return a > 0 ? 1 : a < 0 ? -1 : 0;
}
)"},
    {"$NAME_min", R"(
static $REAL $NAME_min($REAL a, $REAL b)
{
  return b < a ? b : a;
}
)"},
    {"$NAME_max", R"(
static $REAL $NAME_max($REAL a, $REAL b)
{
  return a < b ? b : a;
}
)"},
    {"$NAME_power", R"(
static $REAL $NAME_power($REAL a, int exponent)
{
  $REAL result = 1;
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 == 1) {
      result *= a;
    }
    a *= a;
  }
  return result;
}
)"},
    {"$NAME_tanh", R"(
/* Near 0, where 1 - exp loses digits, by its continued fraction. */
static $REAL $NAME_tanh($REAL a)
{
  const $REAL s = a * a;
  if (4 * s < 1) {
    return a / (1 + s / (3 + s / (5 + s / (7 + s / (9 + s / (11 + s / (13 + s / 15)))))));
  }
  return a > 0 ? 2 / (1 + $EXP(-2 * a)) - 1 : 1 - 2 / (1 + $EXP(2 * a));
}
)"},
    {"$NAME_chain", R"(
/* What doesn't move has no slope, however steep the function is there. */
static $REAL $NAME_chain($REAL steepness, $REAL slope)
{
  return slope < 0 || slope > 0 ? steepness * slope : 0;
}
)"},
    {"$NAME_abs_slope", R"(
static $REAL $NAME_abs_slope($REAL a, $REAL slope)
{
  return a > 0 || (a == 0 && slope > 0) ? slope : -slope;
}
)"},
    {"$NAME_min_slope", R"(
static $REAL $NAME_min_slope($REAL a, $REAL b, $REAL slope_a, $REAL slope_b)
{
  return a < b ? slope_a : b < a ? slope_b : $NAME_min(slope_a, slope_b);
}
)"},
    {"$NAME_max_slope", R"(
static $REAL $NAME_max_slope($REAL a, $REAL b, $REAL slope_a, $REAL slope_b)
{
  return a < b ? slope_b : b < a ? slope_a : $NAME_max(slope_a, slope_b);
}
)"},
});

}  // namespace

// From the last to the first: a helper calls only those before it.
std::string c_helpers(const std::string& body) {
  std::string code;
  for (const Helper& helper : std::views::reverse(kHelpers)) {
    const std::string call = std::string(helper.name) + "(";
    if (body.find(call) != std::string::npos || code.find(call) != std::string::npos) {
      code.insert(0, helper.code);
    }
  }
  return code;
}

}  // namespace kelpie::format
