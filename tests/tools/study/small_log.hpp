// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/model/settings.hpp"
#include "log/dataset.hpp"

namespace kelpie::testing {

/// A log of two inputs and one or two smooth targets. The first input wanders from −2 to 2 again
/// and again; the second is the row's number over 1,000, so that a spy knows which row it is shown.
inline log::Dataset small_log(std::size_t rows, std::size_t targets = 1) {
  log::Dataset data;
  data.source = "small.csv";
  data.input_names = {"u", "row"};
  data.target_names =
      targets == 1 ? std::vector<std::string>{"udot"} : std::vector<std::string>{"udot", "vdot"};
  for (std::size_t i = 0; i < rows; ++i) {
    const double u = 2.0 * std::sin(0.37 * static_cast<double>(i));
    data.inputs.insert(data.inputs.end(), {u, static_cast<double>(i) / 1000.0});
    data.targets.push_back(std::sin(2.0 * u));
    if (targets == 2) {
      data.targets.push_back(u * std::abs(u));
    }
    data.times_s.push_back(0.25 * static_cast<double>(i));
    data.configurations.push_back(0);
  }
  data.rows_read = rows;
  data.rate_hz = 4.0;
  return data;
}

/// Settings for small logs: few samples, and no states.
inline ModelSettings small_settings(std::size_t targets, const std::string& buffer) {
  ModelSettings values = ModelSettings::from_preset("default", targets);
  for (const auto& [name, value] : {std::pair<const char*, std::string>{"buffer", buffer},
                                    {"anchors", "20"},
                                    {"warmup", "60"},
                                    {"terms", "u; u*|u|"},
                                    {"states", "none"}}) {
    values.assign(name, value);
  }
  return values;
}

inline std::size_t row_of(double second_input) {
  return static_cast<std::size_t>(std::lround(1000.0 * second_input));
}

/// 0, 1, 2, …
inline std::vector<std::size_t> all_rows(std::size_t rows) {
  std::vector<std::size_t> list(rows);
  std::iota(list.begin(), list.end(), std::size_t{0});
  return list;
}

}  // namespace kelpie::testing
