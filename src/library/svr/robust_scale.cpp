// SPDX-License-Identifier: Apache-2.0
#include "svr/robust_scale.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/quantile.hpp"

namespace kelpie {

void RobustScale::add(double error) {
  errors_[count_++ % kWindow] = std::abs(error);
  if (count_ == least_ || (count_ > least_ && count_ % every_ == 0)) {
    std::array<double, kWindow> errors = errors_;  // quantile() reorders
    value_ = robust_deviation(std::span(errors).first(std::min(count_, kWindow)));
  }
}

void RobustScale::clear() {
  count_ = 0;
  value_ = std::numeric_limits<double>::infinity();
}

void RobustScale::visit(Archive& archive) {
  archive.whole(count_);
  archive.numbers(std::span(errors_).first(std::min(count_, kWindow)));
  archive.any_number(value_);
}

}  // namespace kelpie
