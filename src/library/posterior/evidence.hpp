// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "kelpie/core/archive.hpp"
#include "posterior/tuning.hpp"

namespace kelpie {

/// Evidence for an alternative to the live posterior [nat]: the logarithm of the ratio of both
/// errors, at most 2 a row, in independent samples, since the sum was 0 last (CUSUM: Page 1954),
/// and at most what is enough.
class Evidence {
 public:
  /// `enough`: of evidence [nat].
  explicit Evidence(double enough = kPosterior.nats) : enough_(enough) {}

  /// A row's gain: the errors of the live posterior and of the alternative, beside the least
  /// variance σ² of the noise of both.
  static double gain(double error, double own, double noise) {
    const double floor = kPosterior.least_error * noise + std::numeric_limits<double>::min();
    const double ratio = 0.5 * std::log((error * error + floor) / (own * own + floor));
    return std::clamp(ratio, -kPosterior.most_ratio, kPosterior.most_ratio);
  }

  /// Adds a row's gain, where so many rows make an independent sample.
  void add(double gain, double rows_per_sample) {
    nats_ = std::min(nats_ + gain / rows_per_sample, enough_);
    sum_ += gain;
    rows_ += 1.0;
    if (nats_ <= 0.0) {
      clear();
    }
  }

  void clear() { nats_ = sum_ = rows_ = 0.0; }

  /// Whether `share` of the evidence and of the gain per row that are enough are there.
  bool is_clear(double share = 1.0) const {
    return nats_ >= share * enough_ && sum_ > share * kPosterior.nats_per_row * rows_;
  }
  bool leads() const { return nats_ > kPosterior.nats_per_row; }  ///< Evidence is left.
  double rows() const { return rows_; }                           ///< Since the sum was 0 last.

  void visit(Archive& archive) {  ///< core/archive.hpp
    for (double* const one : {&nats_, &sum_, &rows_}) {
      archive.number(*one);
    }
  }

 private:
  double enough_;
  double nats_ = 0.0, sum_ = 0.0, rows_ = 0.0;
};

}  // namespace kelpie
