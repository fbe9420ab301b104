// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "kelpie/learner/settings.hpp"
#include "lab/soak.hpp"
#include "lab/update_times.hpp"
#include "log/dataset.hpp"

namespace kelpie::lab {

/// A log to measure on, and whether it is simulated.
struct BenchStream {
  log::Dataset data;
  bool simulated = false;
};

/// The amount of measurements.
struct BenchPlan {
  std::size_t window = 900;
  std::size_t compared = 3000;  ///< updates of every solver, side by side, after the window is full
  std::size_t block = 200;      ///< updates of a solver in a turn
  std::size_t whole = 30'000;   ///< updates of the path solver alone and of the learner, at most
  std::vector<std::size_t> windows{225, 450, 900, 1800, 3600};
  std::vector<std::size_t> repeats{1, 2, 4, 8, 16};  ///< of three inputs, for more inputs
  std::size_t growth_updates = 100;                  ///< of each solver and size
  std::size_t kernel_rounds = 2000;
  std::size_t model_updates = 30'000;  ///< of a model with three axes (update_times.hpp)
  /// Called now and then with the finished share; false stops the work.
  std::function<bool(double)> keep_going = [](double) { return true; };
};

BenchPlan quick_bench();  ///< Half a minute.

/// A solver's updates over a stretch of a stream.
struct SolverRun {
  std::string name;
  std::vector<double> update_us;     ///< kernel row, add, solve, release, remove, solve
  std::vector<double> steps;         ///< of the solver, per update
  std::vector<double> free_samples;  ///< after each update; empty for SMO
  std::size_t fallbacks = 0;         ///< updates in which SMO took over
  double gap = 0.0;                  ///< largest KKT gap on residuals computed afresh
};

/// Solvers side by side on an axis of a stream.
struct BenchAxis {
  std::string stream;
  bool simulated = false;
  std::string axis;
  double epsilon = 0.0;
  std::vector<SolverRun> runs;    ///< path (double), path (float), SMO, on the same samples
  std::vector<double> libsvm_us;  ///< from scratch on the window after each block
  SolverRun whole;                ///< path (double) on to the stream's end
  /// The learner with every node and default settings, without physics terms, after `window` rows.
  std::vector<double> learner_update_us;
  std::vector<double> learner_predict_us;
  int learner_buffer = 0;  ///< samples at the end
};

/// Median update times over a growing size.
struct BenchGrowth {
  std::string stream;
  std::string axis;
  std::vector<double> sizes;
  std::vector<double> path_us;
  std::vector<double> smo_us;
};

/// A kernel row, by Highway and by a plain loop over std::exp, and a prediction; median times.
struct BenchKernel {
  std::size_t samples = 0;
  std::size_t inputs = 0;
  double row_us = 0.0;
  double scalar_row_us = 0.0;
  double prediction_us = 0.0;
};

/// Memory of a learner, computed.
struct BenchMemory {
  std::size_t window = 0;
  std::size_t inputs = 0;
  std::size_t path_double = 0;  ///< bytes
  std::size_t path_float = 0;
  std::size_t smo_double = 0;
};

/// The measured times and sizes.
struct BenchResult {
  OnlineSvrSettings settings;  ///< of the solvers, except ε, storage and solver
  std::size_t compared = 0;
  std::size_t block = 0;
  std::vector<BenchAxis> axes;
  std::vector<BenchGrowth> over_window;
  std::vector<BenchGrowth> over_inputs;
  BenchKernel kernel;
  BenchMemory memory;
  UpdateTimes model;
  bool interrupted = false;
};

/// Measures on the calling thread. The solvers take turns on the same samples, so that other load
/// on the machine affects every solver. Inputs and targets are standardised with the stream's
/// moments; ε is the paper's for surge, sway, yaw (0.1, 0.001, 0.1), 0.1 for further axes, C is the
/// paper's, γ 0.15; the rest is the default preset. Throws InputError on a stream with too few rows
/// or too many inputs, and as training_scales().
BenchResult run_bench(const std::vector<BenchStream>& streams, const BenchPlan& plan);

/// The measurements for a terminal, no line wider than 100 columns (long names are cut).
std::string bench_table(const BenchResult& result);

/// All measurements as JSON, times in µs in the order of measurement (measured/performance.md).
std::string bench_json(const BenchResult& result);

/// Histogram and slowest updates, for a terminal.
std::string times_table(const UpdateTimes& times);

/// A line per run for a terminal: gap, allowed gap, times, and the verdict.
std::string soak_table(const std::vector<SoakRun>& runs);

}  // namespace kelpie::lab
