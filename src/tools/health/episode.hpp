// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "health/course.hpp"

namespace kelpie::health {

inline constexpr double kSecondsPerDay = 86400.0;

/// A part of a log that is judged by itself: a dive, or a whole log.
struct Episode {
  std::string mission;  ///< the log
  std::string name;     ///< the mission, or the mission with the number of the dive
  double day = 0.0;     ///< of the middle: since 1970 where dates are known, else since the start
  double hours = 0.0;
};

/// A property of a vehicle that an episode tells.
struct Quantity {
  std::string name;  ///< in words: "surge drag"
  std::string unit;  ///< empty: a factor of the mean over all episodes
};

/// What the episodes of a vehicle tell.
struct HealthTable {
  std::vector<Quantity> quantities;
  std::vector<Episode> episodes;
  /// episodes × quantities; NaN: not told.
  std::vector<std::vector<Estimate>> estimates;
  std::vector<std::string> remarks{};  ///< what was taken off, for the user
};

/// First row of each dive and one past the last, by the depth of every row: parts between times
/// near the surface that go deeper than kTuning.dive_share of the greatest depth. From the middle
/// of the rows near the surface to the next, so that every row is in a dive at most once. Requires
/// finite depths.
std::vector<std::pair<std::size_t, std::size_t>> find_dives(std::span<const double> depths);

}  // namespace kelpie::health
