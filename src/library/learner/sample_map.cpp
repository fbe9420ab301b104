// SPDX-License-Identifier: Apache-2.0
#include "learner/sample_map.hpp"

#include <algorithm>

namespace kelpie {

LinearPart linear_part(const SampleMap& map, std::span<double> z) {
  double zero = 0.0;
  std::ranges::fill(z, 0.0);
  map(z, zero);
  double one = 1.0;
  std::ranges::fill(z, 1.0);
  map(z, one);
  return {.gain = one - zero, .offset = zero};
}

}  // namespace kelpie
