// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "kelpie/learner/settings.hpp"
#include "lab/update_times.hpp"
#include "log/dataset.hpp"

namespace kelpie::lab {

/// A log to measure on, and whether it is simulated.
struct BenchStream {
  log::Dataset data;
  bool simulated = false;
};

/// How much is measured.
struct BenchPlan {
  std::size_t window = 900;
  std::size_t compared = 3000;  ///< updates of every solver, side by side, after the window is full
  std::size_t block = 200;      ///< updates of one solver before it is the next one's turn
  std::size_t whole = 30'000;   ///< updates of the path solver alone and of the learner, at most
  std::vector<std::size_t> windows{225, 450, 900, 1800, 3600};
  std::vector<std::size_t> repeats{1, 2, 4, 8, 16};  ///< of three inputs, to make them more
  std::size_t growth_updates = 100;                  ///< of each solver and size
  std::size_t kernel_rounds = 2000;
  std::size_t model_updates = 30'000;  ///< of a model with three axes (update_times.hpp)
  /// Called with the share that is done, now and then; false stops the work.
  std::function<bool(double)> keep_going = [](double) { return true; };
};

/// The plan for a look in half a minute.
BenchPlan quick_bench();

/// One solver's updates over a stretch of a stream.
struct SolverRun {
  std::string name;
  std::vector<double> update_us;     ///< kernel row, add, solve, release, remove, solve
  std::vector<double> steps;         ///< of the solver, per update
  std::vector<double> free_samples;  ///< after each update; empty for SMO
  std::size_t fallbacks = 0;         ///< updates in which SMO took over
  double gap = 0.0;                  ///< largest KKT gap on residuals computed afresh
};

/// Solvers side by side on one axis of one stream.
struct BenchAxis {
  std::string stream;
  bool simulated = false;
  std::string axis;
  double epsilon = 0.0;
  std::vector<SolverRun> runs;    ///< path (double), path (float), SMO, on the same samples
  std::vector<double> libsvm_us;  ///< from scratch on the window as it stood after each block
  SolverRun whole;                ///< path (double) on to the stream's end
  /// The learner with all its nodes and default settings, without physics terms, from a full
  /// window's worth of rows on.
  std::vector<double> learner_update_us;
  std::vector<double> learner_predict_us;
  int learner_buffer = 0;  ///< samples in it at the end
};

/// Median update times over one size that grows.
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

/// Memory of one learner, computed.
struct BenchMemory {
  std::size_t window = 0;
  std::size_t inputs = 0;
  std::size_t path_double = 0;  ///< bytes
  std::size_t path_float = 0;
  std::size_t smo_double = 0;
};

/// All times and sizes that were measured.
struct BenchResult {
  OnlineSvrSettings settings;  ///< of all solvers, but for ε, storage and the solver
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

/// Measures everything in this process and on this thread, the solvers taking turns on the same
/// samples, so that whatever else the machine does meets them all. Inputs and targets are
/// standardised with the stream's own moments; ε is the paper's for surge, sway, yaw (0.1, 0.001,
/// 0.1), 0.1 for further axes, C is the paper's and γ 0.15; the rest is the default preset.
/// Throws InputError on a stream with too few rows or more inputs than can be, and as
/// training_scales() does.
BenchResult run_bench(const std::vector<BenchStream>& streams, const BenchPlan& plan);

}  // namespace kelpie::lab
