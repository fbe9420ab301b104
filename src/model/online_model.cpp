// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/online_model.hpp"

namespace kelpie {

void OnlineModel::update(std::span<const double> x, std::span<const double> y, double t,
                         const AxisDone& done) {
  for (std::size_t i = 0; i < axes(); ++i) {
    decisions_[i] = learner(i).update(x, y[i], t);
    if (done) {
      done(i);
    }
  }
  share_changes();
}

void OnlineModel::share_changes() {
  for (const Decision& found : decisions_) {
    for (std::size_t i = 0; found.changed && i < axes(); ++i) {
      if (!decisions_[i].changed) {
        learner(i).alert(found.changed_since, found.recalled == 0);
      }
    }
  }
}

}  // namespace kelpie
