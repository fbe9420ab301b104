// SPDX-License-Identifier: Apache-2.0
#include "kelpie/online/calibration_slope.hpp"

#include <algorithm>

namespace kelpie {
namespace {

constexpr double kKeepSlope = 0.999;  // λ: the last 1,000 samples have the say
constexpr double kPrior = 10.0;       // w
constexpr double kClip = 3.0;         // standard deviations that one sample counts

}  // namespace

void CalibrationSlope::add(double said, double was) {
  const double s = std::clamp(said, -kClip, kClip);
  const double y = std::clamp(was, -kClip, kClip);
  product_ = kKeepSlope * product_ + s * y;
  square_ = kKeepSlope * square_ + s * s;
}

double CalibrationSlope::value() const {
  return std::clamp((product_ + kPrior) / (square_ + kPrior), kLeast, 1.0);
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
