// SPDX-License-Identifier: Apache-2.0
#include "learner/calibration_slope.hpp"

#include <algorithm>
#include "learner/tuning.hpp"

namespace kelpie {

void CalibrationSlope::add(double said, double was) {
  const double s = std::clamp(said, -kOnline.shares.slope_clip, kOnline.shares.slope_clip);
  const double y = std::clamp(was, -kOnline.shares.slope_clip, kOnline.shares.slope_clip);
  product_ = kOnline.shares.slope_keep * product_ + s * y;
  square_ = kOnline.shares.slope_keep * square_ + s * s;
}

double CalibrationSlope::value() const {
  return std::clamp(
      (product_ + kOnline.shares.slope_prior) / (square_ + kOnline.shares.slope_prior), kLeast,
      1.0);
}

void CalibrationSlope::halve() {
  product_ *= 0.5;
  square_ *= 0.5;
}

void CalibrationSlope::visit(Archive& archive) {
  archive.number(product_);
  archive.number(square_);
  archive.require(square_ >= 0.0, "holds a sum of squares below 0");
}

}  // namespace kelpie
