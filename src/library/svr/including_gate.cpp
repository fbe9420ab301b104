// SPDX-License-Identifier: Apache-2.0
#include "svr/including_gate.hpp"

#include <algorithm>
#include <cmath>

namespace kelpie {

Verdict IncludingGate::check(std::span<const double> similarity, std::span<const double> targets,
                             double predicted, double y) const {
  const auto close = [&](double kappa) { return kappa > xi_; };
  if (std::abs(predicted - y) < epsilon_ && std::ranges::any_of(similarity, close)) {  // eq. (9)
    return Verdict::explained;
  }
  for (std::size_t i = 0; i < similarity.size(); ++i) {
    if (similarity[i] > a_ && std::abs(y - targets[i]) < b_) {  // eq. (10)
      return Verdict::duplicate;
    }
  }
  return Verdict::accepted;
}

}  // namespace kelpie
