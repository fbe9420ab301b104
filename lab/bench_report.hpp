// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lab/bench.hpp"
#include "lab/soak.hpp"

namespace kelpie::lab {

/// The measurements for a terminal, no line wider than 100 columns (long names are cut).
std::string bench_table(const BenchResult& result);

/// All measurements as JSON, times in µs in the order of measurement (docs/performance.md).
std::string bench_json(const BenchResult& result);

/// Histogram and slowest updates, for a terminal.
std::string times_table(const UpdateTimes& times);

/// A line per run for a terminal: gap, allowed gap, times, and the verdict.
std::string soak_table(const std::vector<SoakRun>& runs);

}  // namespace kelpie::lab
