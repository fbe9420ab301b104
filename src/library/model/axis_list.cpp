// SPDX-License-Identifier: Apache-2.0
#include "model/axis_list.hpp"

#include "kelpie/core/error.hpp"

namespace kelpie {

void AxisList::update(std::span<const double> x, std::span<const double> y, double t,
                      const AxisDone& done) {
  const AccessGuard::Writer writer(state_.access);
  require_size("y", y.size(), axes());
  const double now = state_.clock.at(t);
  for (std::size_t i = 0; i < axes(); ++i) {
    state_.decisions[i] = axes_[i]->update(x, y[i], now);
    if (done) {
      done(i);
    }
  }
  state_.share_changes([&](std::size_t i) -> OnlineRegressor& { return *axes_[i]; });
  state_.stamp_changes();
}

void AxisList::learn_held_back() {
  const AccessGuard::Writer writer(state_.access);
  for (const std::unique_ptr<OnlineRegressor>& axis : axes_) {
    axis->learn_held_back();
  }
}

}  // namespace kelpie
