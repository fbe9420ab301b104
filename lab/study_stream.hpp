// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "lab/reproduction.hpp"
#include "log/dataset.hpp"
#include "study/split.hpp"
#include "vehicle/scenario.hpp"

namespace kelpie::lab {

/// The log of one seed, and its split by each kind in kSplitKinds.
struct SeedData {
  log::Dataset data;
  std::vector<study::Split> splits;
};

/// The split of the paper, and a split by blocks of time.
inline constexpr std::array kSplitKinds{study::SplitKind::random, study::SplitKind::blocks};

/// A scenario of a folder, with phases shortened to `share`. Throws InputError with the nearest
/// name for an unknown scenario.
vehicle::Scenario planned_scenario(const std::filesystem::path& folder, const std::string& name,
                                   double share);

/// Simulates and splits with the seed. With `full_range_only` the held-out rows hold phases of full
/// amplitude only.
SeedData simulated_data(vehicle::Scenario scenario, const std::string& source, std::uint64_t seed,
                        bool full_range_only);

/// The real log of the plan's folder.
log::Dataset real_data(const ReproductionPlan& plan);

/// The first `rows` rows; 0: the whole log.
log::Dataset first_rows(log::Dataset data, std::size_t rows);

/// Splits the log with this seed.
SeedData split_data(log::Dataset data, std::uint64_t seed);

/// The rows with a single target.
log::Dataset one_target(const log::Dataset& data, std::size_t axis);

}  // namespace kelpie::lab
