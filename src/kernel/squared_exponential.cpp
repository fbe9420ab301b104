// SPDX-License-Identifier: Apache-2.0
#include "kelpie/kernel/squared_exponential.hpp"

#include <Eigen/Core>
#include <algorithm>

namespace kelpie {

void SquaredExponential::row(std::span<const double> z, const SampleStore& samples,
                             std::size_t first, std::span<double> out) const {
  // Short stretches, so that the sums stay in the nearest cache over all coordinates.
  constexpr std::size_t kStretch = 256;
  using Map = Eigen::Map<Eigen::ArrayXd>;
  using ConstMap = Eigen::Map<const Eigen::ArrayXd>;
  for (std::size_t start = 0; start < out.size(); start += kStretch) {
    const std::size_t count = std::min(kStretch, out.size() - start);
    const auto length = static_cast<Eigen::Index>(count);
    Map sum(out.data() + start, length);
    sum.setZero();
    for (std::size_t k = 0; k < samples.dimension(); ++k) {
      sum += (ConstMap(samples.coordinate(k).data() + first + start, length) - z[k]).square();
    }
    sum = (-gamma_ * sum).exp();
  }
}

}  // namespace kelpie
