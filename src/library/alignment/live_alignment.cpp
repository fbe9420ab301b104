// SPDX-License-Identifier: Apache-2.0
#include "kelpie/alignment/live_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "kelpie/core/error.hpp"
#include "motion/states.hpp"

namespace kelpie {

LiveAlignment::LiveAlignment(std::vector<std::string> inputs, std::size_t targets, double rate_hz,
                             std::string states, std::size_t keep,
                             std::map<std::string, Actuator> known)
    : names_(std::move(inputs)),
      targets_(targets),
      rate_hz_(rate_hz),
      states_(std::move(states)),
      known_(std::move(known)),
      most_(keep),
      rows_(aligned_rows()),
      ring_(keep * (names_.size() + targets + 1)) {
  require(keep >= kFirstSearch, "keep",
          "has to be " + std::to_string(kFirstSearch) + " rows or more");
  find_states(states_, names_, targets_);  // has the check
}

bool LiveAlignment::is_finite(std::span<const double> x, std::span<const double> y, double t) {
  const auto all = [](std::span<const double> values) {
    return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
  };
  return all(x) && all(y) && std::isfinite(t);
}

void LiveAlignment::keep(std::span<const double> x, std::span<const double> y, double t) {
  require_size("x", x.size(), names_.size());
  require_size("y", y.size(), targets_);
  const std::size_t width = names_.size() + targets_ + 1;
  auto place = ring_.begin() + static_cast<std::ptrdiff_t>(written_ % most_ * width);
  place = std::ranges::copy(x, place).out;
  *std::ranges::copy(y, place).out = t;
  newest_s_ = t;
  ++written_;
  ++seen_;
  kept_ = std::min(kept_ + 1, most_);
}

std::span<const double> LiveAlignment::kept_row(std::size_t i) const {
  const std::size_t width = names_.size() + targets_ + 1;
  return std::span(ring_).subspan((written_ - kept_ + i) % most_ * width, width);
}

AlignmentResult LiveAlignment::search(bool afresh) const {
  std::vector<double> inputs;
  std::vector<double> targets;
  std::vector<double> times_s;
  times_s.reserve(kept_);
  for (std::size_t i = 0; i < kept_; ++i) {
    const std::span<const double> row = kept_row(i);
    std::ranges::copy(row.first(names_.size()), std::back_inserter(inputs));
    std::ranges::copy(row.subspan(names_.size(), targets_), std::back_inserter(targets));
    times_s.push_back(row.back());
  }
  std::vector<std::size_t> rows(kept_);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  AlignmentResult found{.alignment = alignment_, .gain = 0.0, .why = "no rows are kept"};
  if (!rows.empty()) {
    found = find_alignment({.inputs = inputs,
                            .targets = targets,
                            .times_s = times_s,
                            .configurations = {},
                            .rows = rows,
                            .input_names = names_,
                            .target_count = targets_,
                            .states = states_,
                            .rate_hz = rate_hz_,
                            .current = afresh ? Alignment{} : alignment_,
                            .known = known_});
  }
  return found;
}

bool LiveAlignment::adopt(const AlignmentResult& found) {
  next_search_ = seen_ + std::min(std::max(kept_, kFirstSearch), most_);
  const bool is_another =
      found.alignment.rows != alignment_.rows || found.alignment.actuators != alignment_.actuators;
  if (is_another) {
    alignment_ = found.alignment;
    replay([](std::span<const double>, std::span<const double>, double) {});
  }
  return is_another;
}

AlignedRows LiveAlignment::aligned_rows() const {
  std::vector<std::size_t> commands;
  commands.reserve(alignment_.commands.size());
  for (const std::string& name : alignment_.commands) {
    commands.push_back(static_cast<std::size_t>(std::ranges::find(names_, name) - names_.begin()));
  }
  return {alignment_.rows, commands, names_.size(), targets_, rate_hz_, alignment_.actuators};
}

}  // namespace kelpie
