// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "chart/text_table.hpp"
#include "lab/bench.hpp"

namespace kelpie::lab {

// What table, JSON and page say of the measurements.

/// How many times longer SMO and LIBSVM (from scratch) take than the path solver, by medians.
struct Speedup {
  double smo = 0.0;
  double libsvm = 0.0;
};
Speedup speedup_of(const BenchAxis& axis);

/// Growth exponents of path and SMO over the sizes from `least` on.
std::pair<double, double> exponents_of(const BenchGrowth& growth, double least);

/// The last part of a stream's name, and that it is simulated where it is.
std::string stream_text(const BenchAxis& axis);

/// All tables, in order.
std::vector<chart::TextTable> bench_tables(const BenchResult& result);

/// What was measured how, in a sentence or two.
std::string bench_method(const BenchResult& result);

}  // namespace kelpie::lab
