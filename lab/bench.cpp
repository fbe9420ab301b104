// SPDX-License-Identifier: Apache-2.0
#include "lab/bench.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "core/quantile.hpp"
#include "kelpie/core/error.hpp"
#include "lab/offline_svr.hpp"
#include "lab/sliding_window.hpp"
#include "learner/adaptive_svr.hpp"
#include "study/training_scales.hpp"
#include "svr/svr_function.hpp"

namespace kelpie::lab {
namespace {

constexpr std::size_t kTurn = 25;  // updates of one solver before it is the other's turn
constexpr std::size_t kFewInputs = 3;
constexpr std::size_t kBatch = 16;  // calls too short for the clock are timed together

// One axis of a stream, standardised.
struct BenchSamples {
  std::string stream;
  bool simulated = false;
  std::string axis;
  std::size_t inputs = 0;
  std::vector<double> z;  // row-major, rows × inputs
  std::vector<double> y;
  std::vector<double> times_s;
  OnlineSvrSettings settings;

  std::size_t rows() const { return y.size(); }
  std::span<const double> input(std::size_t row) const {
    return std::span(z).subspan(row * inputs, inputs);
  }
};

// Hears whether to go on while updates are counted.
class BenchProgress {
 public:
  BenchProgress(const BenchPlan& plan, double planned) : plan_(plan), planned_(planned) {}

  // False when the work is to stop, from then on.
  bool advance(double updates) {
    done_ += updates;
    stopped_ = stopped_ || !plan_.keep_going(done_ < planned_ ? done_ / planned_ : 1.0);
    return !stopped_;
  }
  bool stopped() const { return stopped_; }

 private:
  const BenchPlan& plan_;
  double planned_;
  double done_ = 0.0;
  bool stopped_ = false;
};

struct Medians {
  double path_us = 0.0;
  double smo_us = 0.0;
};

// The path solver fills the window for both; then both go on, the first turn being untimed, so
// that each is on its own way.
Medians median_updates(const BenchSamples& samples, std::size_t updates, BenchProgress& progress) {
  const auto window = static_cast<std::size_t>(samples.settings.buffer);
  SlidingWindow path(samples.inputs, samples.settings);
  for (std::size_t row = 0; row < window; ++row) {
    path.step(samples.input(row), samples.y[row]);
  }
  SlidingWindow smo = path;
  smo.switch_to_smo();
  std::vector<double> path_us;
  std::vector<double> smo_us;
  const auto turn = [&](SlidingWindow& solver, std::size_t first, std::vector<double>& times) {
    const std::size_t last = std::min(first + kTurn, window + kTurn + updates);
    for (std::size_t row = first; row < last && progress.advance(1.0); ++row) {
      times.push_back(timed_us([&] { solver.step(samples.input(row), samples.y[row]); }));
    }
  };
  for (std::size_t first = window; first < window + kTurn + updates; first += kTurn) {
    turn(path, first, path_us);
    turn(smo, first, smo_us);
    if (first == window) {
      path_us.clear();
      smo_us.clear();
    }
  }
  return progress.stopped() ? Medians{} : Medians{quantile(path_us, 0.5), quantile(smo_us, 0.5)};
}

void add_size(BenchGrowth& growth, const BenchSamples& samples, std::size_t size,
              const BenchPlan& plan, BenchProgress& progress) {
  if (progress.stopped()) {
    return;
  }
  const Medians medians = median_updates(samples, plan.growth_updates, progress);
  if (!progress.stopped()) {
    growth.sizes.push_back(static_cast<double>(size));
    growth.path_us.push_back(medians.path_us);
    growth.smo_us.push_back(medians.smo_us);
  }
}

// The problem of the first few inputs with more inputs: each stands there several times, made
// smaller so that all distances, and so the kernel, stay what they are.
BenchSamples repeated(const BenchSamples& samples, std::size_t few, std::size_t times) {
  BenchSamples more = samples;
  more.inputs = few * times;
  more.z.clear();
  const double factor = 1.0 / std::sqrt(static_cast<double>(times));
  for (std::size_t row = 0; row < samples.rows(); ++row) {
    for (std::size_t k = 0; k < more.inputs; ++k) {
      more.z.push_back(factor * samples.input(row)[k % few]);
    }
  }
  return more;
}

// As anybody would write it, samples one after the other in memory.
void plain_row(const std::vector<double>& samples, std::span<const double> z, double gamma,
               std::vector<double>& out) {
  const std::size_t d = z.size();
  for (std::size_t i = 0; i < out.size(); ++i) {
    double square = 0.0;
    for (std::size_t k = 0; k < d; ++k) {
      const double difference = samples[i * d + k] - z[k];
      square += difference * difference;
    }
    out[i] = std::exp(-gamma * square);
  }
}

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

  void judge() { run.gap = std::max(run.gap, kkt_afresh(window.problem()).gap()); }
};

double libsvm_us(const SlidingWindow& window, const OnlineSvrSettings& settings) {
  OfflineSvrSettings same;
  same.gamma = settings.gamma;
  same.c = settings.c;
  same.epsilon = settings.epsilon;
  same.tolerance = settings.tolerance;
  const std::span<const double> held = window.problem().targets();
  const std::vector<double> targets(held.begin(), held.end());
  return timed_us([&] { train_by_libsvm(window.samples(), targets, same); });
}

// Updates of which there are enough rows after the window is full.
std::size_t possible(std::size_t updates, const BenchSamples& samples, const BenchPlan& plan) {
  return std::min(updates, samples.rows() - plan.window);
}

double growth_updates(const BenchPlan& plan) {
  return static_cast<double>(2 * (plan.windows.size() + plan.repeats.size()) *
                             (plan.growth_updates + kTurn));
}

BenchGrowth growth_over_window(const BenchSamples& samples, const BenchPlan& plan,
                               BenchProgress& progress) {
  BenchGrowth growth{samples.stream, samples.axis, {}, {}, {}};
  for (const std::size_t window : plan.windows) {
    if (window + plan.growth_updates + kTurn <= samples.rows()) {
      BenchSamples sized = samples;
      sized.settings.buffer = static_cast<int>(window);
      add_size(growth, sized, window, plan, progress);
    }
  }
  return growth;
}

BenchGrowth growth_over_inputs(const BenchSamples& samples, const BenchPlan& plan,
                               BenchProgress& progress) {
  BenchGrowth growth{samples.stream, samples.axis, {}, {}, {}};
  const std::size_t few = std::min(kFewInputs, samples.inputs);
  for (const std::size_t times : plan.repeats) {
    add_size(growth, repeated(samples, few, times), times * few, plan, progress);
  }
  return growth;
}

BenchKernel measure_kernel(const BenchSamples& samples, const BenchPlan& plan) {
  const std::size_t n = std::max<std::size_t>(1, plan.window);
  const SquaredExponential kernel(samples.settings.gamma);
  SampleStore store(samples.inputs, n);
  std::vector<double> rows;
  for (std::size_t row = 0; row < n; ++row) {
    store.push_back(samples.input(row));
    rows.insert(rows.end(), samples.input(row).begin(), samples.input(row).end());
  }
  SvrFunction function({kernel, samples.inputs}, n);
  function.assign(store, std::vector<double>(n, 1.0), 0.0);
  std::vector<double> out(n);
  double sum = 0.0;
  std::array<std::vector<double>, 3> times;
  for (std::size_t round = 0; round < plan.kernel_rounds; ++round) {
    const auto batch = [&](std::size_t which, auto work) {
      times.at(which).push_back(timed_us([&] {
                                  for (std::size_t k = 0; k < kBatch; ++k) {
                                    work(samples.input((round * kBatch + k) % samples.rows()));
                                    sum += out[k % n];
                                  }
                                }) /
                                static_cast<double>(kBatch));
    };
    batch(0, [&](std::span<const double> z) { kernel.row(z, store, out); });
    batch(1, [&](std::span<const double> z) { plain_row(rows, z, kernel.gamma(), out); });
    batch(2, [&](std::span<const double> z) { out[0] = function(z); });
  }
  // The sum is looked at, so that no compiler leaves the work out.
  return {.samples = std::isfinite(sum) ? n : 0,
          .inputs = samples.inputs,
          .row_us = quantile(times[0], 0.5),
          .scalar_row_us = quantile(times[1], 0.5),
          .prediction_us = quantile(times[2], 0.5)};
}

double compare_updates(const BenchSamples& samples, const BenchPlan& plan) {
  // All three solvers, the path alone from there on, then the learner from the first row.
  return static_cast<double>(2 * possible(plan.compared, samples, plan) +
                             2 * possible(plan.whole, samples, plan) + plan.window);
}

void compare_solvers(const BenchSamples& samples, const BenchPlan& plan, BenchProgress& progress,
                     BenchAxis& axis) {
  OnlineSvrSettings single = samples.settings;
  single.storage = Storage::float32;
  for (const char* const name : {"path", "path, float", "SMO"}) {
    axis.runs.push_back({.name = name, .update_us = {}, .steps = {}, .free_samples = {}});
  }
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

  const std::size_t end = plan.window + possible(plan.compared, samples, plan);
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
  const std::size_t rows = plan.window + possible(plan.whole, samples, plan);
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
  const std::size_t rows = plan.window + possible(plan.whole, samples, plan);
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
