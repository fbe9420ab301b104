// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lab/bench.hpp"
#include "lab/soak.hpp"

namespace kelpie::lab {

/// The measurements for a terminal, no line wider than 100 columns (long names are cut).
std::string bench_table(const BenchResult& result);

/// Everything as JSON, all times in µs, in the order they were taken (docs/performance.md).
std::string bench_json(const BenchResult& result);

/// One page with the tables and figures, as report_html() makes them.
std::string bench_html(const BenchResult& result);

/// Histogram and slowest updates, for a terminal.
std::string times_table(const UpdateTimes& times);

/// A line per run: what was reached, what was allowed, and whether it was kept.
std::string soak_table(const std::vector<SoakRun>& runs);

}  // namespace kelpie::lab
