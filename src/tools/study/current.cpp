// SPDX-License-Identifier: Apache-2.0
#include "study/current.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "kelpie/core/error.hpp"
#include "study/alignment.hpp"
#include "study/baselines.hpp"

namespace kelpie::study {
CurrentResult choose_current(const log::Dataset& data, const Split& split,
                             const std::string& states, const Alignment& alignment) {
  if (data.headings.empty()) {
    return {};
  }
  if (!std::ranges::all_of(data.headings, [](double heading) { return std::isfinite(heading); })) {
    return {.current = {}, .gain = 0.0, .why = data.heading_column + " is not known in every row"};
  }
  const log::Dataset rows = aligned(without_inputs(data, {data.heading_column}), alignment);
  return find_current(alignment_problem(rows, split, states), rows.heading_column, rows.headings);
}

std::string current_text(const CurrentResult& found) {
  return (found.current.none() ? "still water" : found.current.text()) + ": " + found.why;
}

log::Dataset through_water(log::Dataset data, const Current& current) {
  if (current.none()) {
    return data;
  }
  data = without_inputs(std::move(data), {current.heading});
  const std::size_t surge = data.require_input(current.surge, "is needed to take off the current");
  const std::size_t sway = data.require_input(current.sway, "is needed to take off the current");
  const std::size_t yaw_rate =
      data.require_input(current.yaw_rate, "is needed to take off the current");
  for (std::size_t row = 0; row < data.rows(); ++row) {
    if (row >= data.headings.size() || !std::isfinite(data.headings[row])) {
      throw InputError({.file = data.source, .line = 0, .field = current.heading},
                       "is needed in every row to take off the current");
    }
    const auto [ahead, aside] = current.in_body(data.headings[row], data.times_s[row]);
    const std::span x =
        std::span(data.inputs).subspan(row * data.input_names.size(), data.input_names.size());
    x[surge] -= ahead;
    x[sway] -= aside;
    if (!data.target_names.empty()) {
      const std::span y =
          std::span(data.targets).subspan(row * data.target_names.size(), data.target_names.size());
      y[current.targets[0]] -= x[yaw_rate] * aside;
      y[current.targets[1]] += x[yaw_rate] * ahead;
    }
  }
  return data;
}

}  // namespace kelpie::study
