// SPDX-License-Identifier: Apache-2.0
#include "lab/bench.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "kelpie/core/error.hpp"
#include "lab/bench_parts.hpp"
#include "lab/offline_svr.hpp"
#include "lab/sliding_window.hpp"
#include "learner/adaptive_svr.hpp"
#include "study/training_scales.hpp"

namespace kelpie::lab {
namespace {

// The window's problem is the paper's: its ε and C. With a smaller C all solvers have less to do.
constexpr std::array kPaperEpsilon{0.1, 0.001, 0.1};
constexpr double kPaperC = 10.0;
constexpr double kGamma = 0.15;

void require_rows(const BenchStream& stream, const BenchPlan& plan) {
  const std::size_t least = plan.window + 2 * plan.block;
  if (stream.data.rows() < least) {
    throw InputError({.file = stream.data.source, .line = 0, .field = {}},
                     "has " + std::to_string(stream.data.rows()) + " rows; a window of " +
                         std::to_string(plan.window) + " needs " + std::to_string(least));
  }
  if (stream.data.input_names.size() > kMostInputs) {
    throw InputError({.file = stream.data.source, .line = 0, .field = "inputs"},
                     "are " + std::to_string(stream.data.input_names.size()) +
                         "; a model takes 1 to " + std::to_string(kMostInputs));
  }
}

std::vector<BenchSamples> samples_of(const BenchStream& stream, const BenchPlan& plan) {
  require_rows(stream, plan);
  const log::Dataset& data = stream.data;
  std::vector<std::size_t> rows(data.rows());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  const std::vector<AxisScaling> scales = study::training_scales(data, rows, SharedSettings{});
  std::vector<BenchSamples> axes;
  for (std::size_t axis = 0; axis < scales.size(); ++axis) {
    BenchSamples& samples = axes.emplace_back();
    samples.stream = data.source;
    samples.simulated = stream.simulated;
    samples.axis = data.target_names[axis];
    samples.inputs = data.input_names.size();
    samples.times_s = data.times_s;
    samples.settings.buffer = static_cast<int>(plan.window);
    samples.settings.c = kPaperC;
    samples.settings.gamma = kGamma;
    samples.settings.epsilon = axis < kPaperEpsilon.size() ? kPaperEpsilon[axis] : 0.1;
    for (const std::size_t row : rows) {
      const ScaledInput z = scales[axis].input.apply(data.input(row));
      samples.z.insert(samples.z.end(), z.begin(), z.end());
      samples.y.push_back(scales[axis].target.apply(data.target(row)[axis]));
    }
  }
  return axes;
}

// A solver on its way along a stream.
struct TimedWindow {
  SlidingWindow window;
  SolverRun& run;

  void update(const BenchSamples& samples, std::size_t row) {
    SolveReport report;
    run.update_us.push_back(
        timed_us([&] { report = window.step(samples.input(row), samples.y[row]); }));
    run.steps.push_back(report.iterations);
    run.fallbacks += report.fell_back ? 1 : 0;
    if (const std::size_t free = window.free_samples(); free > 0) {
      run.free_samples.push_back(static_cast<double>(free));
    }
  }

  void judge() { run.gap = std::max(run.gap, window.problem().kkt_afresh().gap()); }
};

std::vector<double> targets_of(const SlidingWindow& window) {
  const std::span<const double> targets = window.problem().targets();
  return {targets.begin(), targets.end()};
}

double libsvm_us(const SlidingWindow& window, const OnlineSvrSettings& settings) {
  OfflineSvrSettings same;
  same.gamma = settings.gamma;
  same.c = settings.c;
  same.epsilon = settings.epsilon;
  same.tolerance = settings.tolerance;
  const std::vector<double> targets = targets_of(window);
  return timed_us([&] { train_by_libsvm(window.samples(), targets, same); });
}

std::size_t compared_updates(const BenchSamples& samples, const BenchPlan& plan) {
  return std::min(plan.compared, samples.rows() - plan.window);
}

std::size_t whole_updates(const BenchSamples& samples, const BenchPlan& plan) {
  return std::min(plan.whole, samples.rows() - plan.window);
}

}  // namespace

BenchPlan quick_bench() {
  BenchPlan plan;
  plan.compared = 200;
  plan.block = 100;
  plan.whole = 1000;
  plan.windows = {225, 450, 900};
  plan.repeats = {1, 16};
  plan.growth_updates = 30;
  plan.kernel_rounds = 300;
  plan.model_updates = 1000;
  return plan;
}

double compare_updates(const BenchSamples& samples, const BenchPlan& plan) {
  // All three solvers, the path alone from there on, then the learner from the first row.
  return static_cast<double>(2 * compared_updates(samples, plan) +
                             2 * whole_updates(samples, plan) + plan.window);
}

void compare_solvers(const BenchSamples& samples, const BenchPlan& plan, BenchProgress& progress,
                     BenchAxis& axis) {
  OnlineSvrSettings single = samples.settings;
  single.storage = Storage::float32;
  axis.runs.resize(3);
  axis.runs[0].name = "path";
  axis.runs[1].name = "path, float";
  axis.runs[2].name = "SMO";
  std::vector<TimedWindow> windows{{SlidingWindow(samples.inputs, samples.settings), axis.runs[0]},
                                   {SlidingWindow(samples.inputs, single), axis.runs[1]}};
  for (std::size_t row = 0; row < plan.window; ++row) {
    for (TimedWindow& window : windows) {
      window.window.step(samples.input(row), samples.y[row]);
    }
  }
  SlidingWindow smo = windows[0].window;
  smo.switch_to_smo();
  windows.push_back({std::move(smo), axis.runs[2]});

  const std::size_t end = plan.window + compared_updates(samples, plan);
  for (std::size_t first = plan.window; first < end && !progress.stopped(); first += plan.block) {
    const std::size_t last = std::min(first + plan.block, end);
    for (TimedWindow& window : windows) {
      for (std::size_t row = first; row < last && progress.advance(1.0); ++row) {
        window.update(samples, row);
      }
      window.judge();
    }
    if (!progress.stopped()) {
      axis.libsvm_us.push_back(libsvm_us(windows[0].window, samples.settings));
    }
  }
  axis.whole = axis.runs[0];
  TimedWindow alone{std::move(windows[0].window), axis.whole};
  const std::size_t rows = plan.window + whole_updates(samples, plan);
  for (std::size_t row = end; row < rows && progress.advance(1.0); ++row) {
    alone.update(samples, row);
    if ((row + 1 - end) % plan.block == 0) {
      alone.judge();
    }
  }
}

void measure_learner(const BenchSamples& samples, const BenchPlan& plan, BenchProgress& progress,
                     BenchAxis& axis) {
  OnlineSvrSettings settings;
  settings.buffer = static_cast<int>(plan.window);
  AdaptiveSvr learner(samples.inputs, settings);
  double sum = 0.0;
  const std::size_t rows = plan.window + whole_updates(samples, plan);
  for (std::size_t row = 0; row < rows && progress.advance(1.0); ++row) {
    const std::span<const double> z = samples.input(row);
    const double update =
        timed_us([&] { learner.update(z, samples.y[row], samples.times_s[row]); });
    const double prediction = timed_us([&] { sum += learner.predict(z); });
    if (row >= plan.window) {
      axis.learner_update_us.push_back(update);
      axis.learner_predict_us.push_back(prediction);
    }
  }
  axis.learner_buffer = std::isfinite(sum) ? learner.status().buffer : 0;
}

BenchResult run_bench(const std::vector<BenchStream>& streams, const BenchPlan& plan) {
  std::vector<BenchSamples> all;
  for (const BenchStream& stream : streams) {
    const std::vector<BenchSamples> axes = samples_of(stream, plan);
    all.insert(all.end(), axes.begin(), axes.end());
  }
  const std::size_t first_stream = streams.front().data.target_names.size();
  double planned = static_cast<double>(first_stream) * growth_updates(plan);
  for (const BenchSamples& samples : all) {
    planned += compare_updates(samples, plan);
  }
  planned += static_cast<double>(plan.model_updates);
  BenchProgress progress(plan, planned);
  BenchResult result;
  result.settings = all.front().settings;
  result.compared = plan.compared;
  result.block = plan.block;
  result.kernel = measure_kernel(all.front(), plan);
  for (const BenchSamples& samples : all) {
    BenchAxis& axis = result.axes.emplace_back();
    axis.stream = samples.stream;
    axis.simulated = samples.simulated;
    axis.axis = samples.axis;
    axis.epsilon = samples.settings.epsilon;
    compare_solvers(samples, plan, progress, axis);
    measure_learner(samples, plan, progress, axis);
  }
  for (std::size_t axis = 0; axis < first_stream; ++axis) {
    result.over_window.push_back(growth_over_window(all[axis], plan, progress));
    result.over_inputs.push_back(growth_over_inputs(all[axis], plan, progress));
  }
  result.model =
      measure_update_times({.updates = plan.model_updates, .keep_going = [&progress](std::size_t) {
                              return progress.advance(1.0);
                            }});
  OnlineSvrSettings settings = result.settings;
  const std::size_t inputs = all.front().inputs;
  result.memory = {.window = plan.window, .inputs = inputs};
  settings.storage = Storage::float32;
  result.memory.path_float = AdaptiveSvr::bytes(inputs, settings);
  settings.storage = Storage::float64;
  result.memory.path_double = AdaptiveSvr::bytes(inputs, settings);
  settings.solver = SolverKind::smo;
  result.memory.smo_double = AdaptiveSvr::bytes(inputs, settings);
  result.interrupted = progress.stopped();
  return result;
}

}  // namespace kelpie::lab
