// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/alignment.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "kelpie/core/error.hpp"

namespace kelpie {
int Alignment::rows_at(double rate_hz) const {
  constexpr double kFarthestRows = 1e6;
  return static_cast<int>(std::lround(std::clamp(lag_s * rate_hz, -kFarthestRows, kFarthestRows)));
}

Alignment Alignment::at(double rate_hz) const {
  const int rows_there = rows_at(rate_hz);
  return {rows_there == 0 ? 0.0 : rows_there / rate_hz, rows_there, commands};
}

AlignedRows::AlignedRows(int rows, std::vector<std::size_t> commands, std::size_t inputs,
                         std::size_t targets, double rate_hz)
    : shift_(rows),
      distance_(static_cast<std::size_t>(std::abs(rows))),
      commands_(std::move(commands)),
      inputs_(inputs),
      targets_(targets),
      longest_step_s_(kLongestStep / rate_hz),
      ring_((distance_ + 1) * (inputs + targets + 1)),
      row_(inputs) {
  if (!(rate_hz > 0.0)) {
    throw InputError("rate", "has to be > 0 rows per second");
  }
  if (std::ranges::any_of(commands_, [&](std::size_t place) { return place >= inputs_; })) {
    throw InputError("commands", "have to be among the inputs");
  }
}

bool AlignedRows::ends_before(double t) const {
  const std::size_t width = inputs_ + targets_ + 1;
  return count_ > 0 &&
         t - ring_[(count_ - 1) % (distance_ + 1) * width + width - 1] > longest_step_s_;
}

std::span<double> AlignedRows::slot(std::size_t row) {
  const std::size_t width = inputs_ + targets_ + 1;
  return std::span(ring_).subspan(row % (distance_ + 1) * width, width);
}

void AlignedRows::keep(std::span<const double> x, std::span<const double> y, double t) {
  require_size("x", x.size(), inputs_);
  require_size("y", y.size(), targets_);
  const std::span<double> place = slot(count_);
  std::ranges::copy(x, place.begin());
  std::ranges::copy(y, place.begin() + static_cast<std::ptrdiff_t>(inputs_));
  place.back() = t;
  ++count_;
}

std::span<const double> AlignedRows::with_commands(std::span<const double> row,
                                                   std::span<const double> from) {
  std::ranges::copy(row.first(inputs_), row_.begin());
  for (const std::size_t command : commands_) {
    row_[command] = from[command];
  }
  return row_;
}

}  // namespace kelpie
