// SPDX-License-Identifier: Apache-2.0
#include "model/warm_up.hpp"

#include <algorithm>

namespace kelpie {

WarmUp::WarmUp(std::size_t inputs, std::size_t most) : width_(inputs + 2), most_(most) {
  rows_.reserve(most_ * width_);
}

void WarmUp::hold(std::span<const double> x, double y, double t) {
  if (full()) {
    drop_oldest(1);
  }
  rows_.insert(rows_.end(), x.begin(), x.end());
  rows_.insert(rows_.end(), {y, t});
}

WarmUp::Sample WarmUp::operator[](std::size_t i) const {
  const std::span<const double> row = std::span(rows_).subspan(i * width_, width_);
  return {.x = row.first(width_ - 2), .y = row[width_ - 2], .t = row[width_ - 1]};
}

void WarmUp::drop_oldest(std::size_t samples) {
  rows_.erase(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(samples * width_));
}

void WarmUp::keep(const std::vector<bool>& samples) {
  auto end = rows_.begin();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i]) {
      end = std::copy_n(rows_.begin() + static_cast<std::ptrdiff_t>(i * width_), width_, end);
    }
  }
  rows_.erase(end, rows_.end());
}

void WarmUp::visit(Archive& archive) {
  std::size_t samples = size();
  archive.length(samples, most_, width_ * sizeof(double));
  rows_.resize(samples * width_);
  archive.numbers(rows_);
}

}  // namespace kelpie
