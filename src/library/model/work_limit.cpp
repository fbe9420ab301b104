// SPDX-License-Identifier: Apache-2.0
#include "model/work_limit.hpp"

#include <algorithm>

#include "model/tuning.hpp"

namespace kelpie {
namespace {

constexpr const auto& kWorkTuning = kModelTuning.work;

// A step of the solution path costs O(n²).
Work least_work(std::size_t axes, std::size_t places) {
  const double more_axes = static_cast<double>(std::max(axes, kWorkTuning.axes)) / kWorkTuning.axes;
  const double more_places =
      static_cast<double>(std::max(places, kWorkTuning.places)) / kWorkTuning.places;
  return static_cast<Work>(kWorkTuning.numbers * more_axes * more_places * more_places);
}

}  // namespace

WorkLimit::WorkLimit(std::size_t axes, std::size_t places)
    : axes_(axes), least_(least_work(axes, places)), most_(least_), left_(most_) {}

Budget WorkLimit::grant(const Budget& budget, std::size_t followers) {
  return budget.sharing(left_, most_ * static_cast<Work>(followers) / static_cast<Work>(2 * axes_));
}

void WorkLimit::learned(bool crowded_out) {
  most_ -= (most_ - least_) / kWorkTuning.decay;
  most_ =
      std::min(most_ + (crowded_out ? most_ / kWorkTuning.growth : 0), kWorkTuning.most * least_);
  left_ = most_;
}

void WorkLimit::visit(Archive& archive) {
  archive.whole(most_, least_, kWorkTuning.most * least_);
  if (archive.loading()) {
    left_ = most_;
  }
}

}  // namespace kelpie
