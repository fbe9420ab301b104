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
namespace {

std::size_t input_called(const log::Dataset& data, const std::string& name) {
  const auto found = std::ranges::find(data.input_names, name);
  if (found == data.input_names.end()) {
    throw InputError({.file = data.source, .line = 0, .field = name},
                     "is needed to take off the current, but is no input");
  }
  return static_cast<std::size_t>(found - data.input_names.begin());
}

}  // namespace

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
  const std::size_t surge = input_called(data, current.surge);
  const std::size_t sway = input_called(data, current.sway);
  const std::size_t yaw_rate = input_called(data, current.yaw_rate);
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
