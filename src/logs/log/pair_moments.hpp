// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace kelpie::log {

/// Moments of pairs of numbers, one pair after the other.
struct PairMoments {
  double n = 0.0;
  double mean_x = 0.0;
  double mean_y = 0.0;
  double xx = 0.0;  ///< sums of products of distances from the means
  double yy = 0.0;
  double xy = 0.0;

  /// Pairs with a number that is not finite are passed over.
  void add(double x, double y) {
    if (!std::isfinite(x) || !std::isfinite(y)) {
      return;
    }
    n += 1.0;
    const double dx = x - mean_x;
    const double dy = y - mean_y;
    mean_x += dx / n;
    mean_y += dy / n;
    xx += dx * (x - mean_x);
    yy += dy * (y - mean_y);
    xy += dx * (y - mean_y);
  }
  bool varies() const { return xx > 0.0 && yy > 0.0; }
  double correlation() const { return varies() ? xy / std::sqrt(xx * yy) : 0.0; }
};

}  // namespace kelpie::log
