// SPDX-License-Identifier: Apache-2.0
#include "model/thinned_rows.hpp"

#include <algorithm>

namespace kelpie {

ThinnedRows::ThinnedRows(std::size_t inputs) : width_(inputs + 2) {
  rows_.reserve(kMost * width_);
}

void ThinnedRows::add(std::span<const double> x, double y, double t) {
  if (++skipped_ < stride_) {
    return;
  }
  skipped_ = 0;
  if (size() == kMost) {
    for (std::size_t i = 1; 2 * i < kMost; ++i) {
      std::copy_n(rows_.begin() + static_cast<std::ptrdiff_t>(2 * i * width_), width_,
                  rows_.begin() + static_cast<std::ptrdiff_t>(i * width_));
    }
    rows_.resize(kMost / 2 * width_);
    stride_ *= 2;
  }
  rows_.insert(rows_.end(), x.begin(), x.end());
  rows_.insert(rows_.end(), {y, t});
}

WarmUp::Sample ThinnedRows::operator[](std::size_t i) const {
  const std::span<const double> row = std::span(rows_).subspan(i * width_, width_);
  return {.x = row.first(width_ - 2), .y = row[width_ - 2], .t = row[width_ - 1]};
}

void ThinnedRows::drop_oldest(std::size_t samples) {
  rows_.erase(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(samples * width_));
}

void ThinnedRows::clear() {
  rows_.clear();
  stride_ = 1;
  skipped_ = 0;
}

void ThinnedRows::visit(Archive& archive) {
  std::size_t samples = size();
  archive.length(samples, kMost, width_ * sizeof(double));
  rows_.resize(samples * width_);
  archive.numbers(rows_);
  archive.whole(stride_);
  archive.whole(skipped_);
}

}  // namespace kelpie
