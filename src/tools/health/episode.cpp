// SPDX-License-Identifier: Apache-2.0
#include "health/episode.hpp"

#include <algorithm>

#include "health/tuning.hpp"

namespace kelpie::health {

std::vector<std::pair<std::size_t, std::size_t>> find_dives(std::span<const double> depths) {
  std::vector<std::pair<std::size_t, std::size_t>> dives;
  if (depths.empty()) {
    return dives;
  }
  const double deepest = *std::ranges::max_element(depths);
  const double near_surface = kTuning.surface_share * deepest;
  const double dive = kTuning.dive_share * deepest;
  std::size_t begin = 0;
  bool under = false;
  double reached = 0.0;
  for (std::size_t row = 0; row < depths.size(); ++row) {
    const bool up = depths[row] <= near_surface;
    reached = std::max(reached, depths[row]);
    if (under && up) {
      if (reached > dive) {
        dives.emplace_back(begin, row);
      }
      begin = row;
      reached = 0.0;
    }
    under = !up;
  }
  if (under && reached > dive) {
    dives.emplace_back(begin, depths.size());
  }
  return dives;
}

}  // namespace kelpie::health
