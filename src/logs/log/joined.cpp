// SPDX-License-Identifier: Apache-2.0
#include "log/dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <string>
#include <utility>

#include "core/seconds.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "log/tuning.hpp"

namespace kelpie::log {
namespace {

template <typename T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

// That two logs can be learned as one.
void require_alike(const Dataset& first, const Dataset& next) {
  const auto require = [&](bool good, const std::string& field, const std::string& message) {
    if (!good) {
      throw InputError({.file = next.source, .field = field}, message);
    }
  };
  const auto other = [](const std::vector<std::string>& names,
                        const std::vector<std::string>& wanted) {
    return "are " + join_text(names, ", ") + "; the first log has " + join_text(wanted, ", ");
  };
  require(next.input_names == first.input_names, "inputs",
          other(next.input_names, first.input_names));
  require(next.target_names == first.target_names, "targets",
          other(next.target_names, first.target_names));
  require(std::abs(next.rate_hz - first.rate_hz) <= 0.1 * first.rate_hz, "rate",
          fmt::format("is {:.4g} Hz; the first log has {:.4g} Hz", next.rate_hz, first.rate_hz));
  require(next.held_out.empty() == first.held_out.empty(), "held-out rows",
          "are marked by a column in some of the logs only");
}

}  // namespace

bool follows(const Dataset& data, std::size_t before, std::size_t row) {
  return row == before + 1 &&
         data.times_s[row] - data.times_s[before] <= kLongestStep / data.rate_hz &&
         data.configurations[row] == data.configurations[before];
}

Dataset rows_since(const Dataset& data, double since_s) {
  constexpr std::size_t kNeeded = 2;
  const auto first = static_cast<std::size_t>(std::ranges::lower_bound(data.times_s, since_s) -
                                              data.times_s.begin());
  if (data.rows() < first + kNeeded) {
    throw InputError({.file = data.source, .field = "--since"},
                     fmt::format("{} s leaves too few rows; the log lasts from {} to {} s", since_s,
                                 data.times_s.front(), data.times_s.back()));
  }
  Dataset rest = data;
  const auto drop = [&](auto& values, std::size_t width) {
    if (!values.empty()) {
      values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(first * width));
    }
  };
  drop(rest.inputs, data.input_names.size());
  drop(rest.targets, data.target_names.size());
  drop(rest.times_s, 1);
  drop(rest.configurations, 1);
  drop(rest.held_out, 1);
  drop(rest.headings, 1);
  drop(rest.poses, 3);
  drop(rest.pose_inputs, data.input_names.size());
  return rest;
}

Dataset joined(std::vector<Dataset> logs) {
  Dataset all = std::move(logs.front());
  if (logs.size() > 1) {  // each log has a current of its own
    all.heading_column.clear();
    all.headings.clear();
  }
  for (const Dataset& next : std::span(logs).subspan(1)) {
    require_alike(all, next);
    const double end = all.times_s.back();
    const double later =
        next.times_s.front() > end ? 0.0 : end + kTuning.joined_gap_s - next.times_s.front();
    std::ranges::transform(next.times_s, std::back_inserter(all.times_s),
                           [&](double time) { return time + later; });
    append(all.inputs, next.inputs);
    append(all.targets, next.targets);
    append(all.poses, next.poses);
    append(all.pose_inputs, next.pose_inputs);
    append(all.configurations, next.configurations);
    append(all.held_out, next.held_out);
    all.rows_read += next.rows_read;
    all.rows_skipped += next.rows_skipped;
    all.source += ", " + next.source;
  }
  return all;
}

}  // namespace kelpie::log
