// SPDX-License-Identifier: Apache-2.0
#include "model/work_limit.hpp"

#include <algorithm>

namespace kelpie {
namespace {

constexpr double kWork = 10e6;  // numbers, of up to kAxes axes with up to kPlaces samples each
constexpr std::size_t kAxes = 3;
constexpr std::size_t kPlaces = 901;
constexpr Work kGrowth = 200;  // part of the limit that a sample turned away adds
constexpr Work kDecay = 8000;  // part of what was added that is lost with an update
constexpr Work kMost = 1000;   // times as much as at first

// A step of the solution path costs O(n²).
Work least_work(std::size_t axes, std::size_t places) {
  const double more_axes = static_cast<double>(std::max(axes, kAxes)) / kAxes;
  const double more_places = static_cast<double>(std::max(places, kPlaces)) / kPlaces;
  return static_cast<Work>(kWork * more_axes * more_places * more_places);
}

}  // namespace

WorkLimit::WorkLimit(std::size_t axes, std::size_t places)
    : axes_(axes), least_(least_work(axes, places)), most_(least_), left_(most_) {}

Budget WorkLimit::grant(const Budget& budget, std::size_t followers) {
  return budget.sharing(left_, most_ * static_cast<Work>(followers) / static_cast<Work>(2 * axes_));
}

void WorkLimit::learned(bool crowded_out) {
  most_ -= (most_ - least_) / kDecay;
  most_ = std::min(most_ + (crowded_out ? most_ / kGrowth : 0), kMost * least_);
  left_ = most_;
}

void WorkLimit::visit(Archive& archive) {
  archive.whole(most_, least_, kMost * least_);
  left_ = most_;
}

}  // namespace kelpie
