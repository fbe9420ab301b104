// SPDX-License-Identifier: Apache-2.0
#include "model/thinned_rows.hpp"

#include <vector>

namespace kelpie {
namespace {

std::vector<bool> every_second() {
  std::vector<bool> marks(ThinnedRows::kMost);
  for (std::size_t i = 0; i < marks.size(); i += 2) {
    marks[i] = true;
  }
  return marks;
}

const std::vector<bool> kEverySecond = every_second();  // made beforehand: add() allocates nothing

}  // namespace

void ThinnedRows::add(std::span<const double> x, double y, double t) {
  if (++skipped_ < stride_) {
    return;
  }
  skipped_ = 0;
  if (rows_.full()) {
    rows_.keep(kEverySecond);
    stride_ *= 2;
  }
  rows_.hold(x, y, t);
}

void ThinnedRows::clear() {
  rows_.drop_oldest(rows_.size());  // WarmUp::clear() would free the memory
  stride_ = 1;
  skipped_ = 0;
}

void ThinnedRows::visit(Archive& archive) {
  rows_.visit(archive);
  archive.whole(stride_);
  archive.whole(skipped_);
}

}  // namespace kelpie
