// SPDX-License-Identifier: Apache-2.0
#include "model/uncertainty.hpp"

#include <cmath>

namespace kelpie {

void Uncertainty::score(Decision& decision, double y, double t) {
  if (!decision.had_model) {
    return;
  }
  Prediction& said = decision.prediction;
  said.lower = said.value - interval_.half_width();
  said.upper = said.value + interval_.half_width();
  interval_.observe(std::abs(y - said.value));
  said.disturbance = disturbance_.at(said.value, t);
  const double corrected = said.value + said.disturbance;
  said.corrected_lower = corrected - corrected_interval_.half_width();
  said.corrected_upper = corrected + corrected_interval_.half_width();
  corrected_interval_.observe(std::abs(y - corrected));
  disturbance_.observe(said.value, y, t);
}

void Uncertainty::refresh(Snapshot& copy) const {
  copy.half_width = interval_.half_width();
  copy.corrected_half_width = corrected_interval_.half_width();
  copy.disturbance = disturbance_;
}

void Uncertainty::visit(Archive& archive) {
  archive.part("interval", interval_);
  archive.part("disturbance", disturbance_);
  archive.part("interval with disturbance", corrected_interval_);
}

}  // namespace kelpie
