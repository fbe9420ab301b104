// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "core/quantile.hpp"
#include "lab/bench_parts.hpp"
#include "lab/sliding_window.hpp"
#include "svr/svr_function.hpp"

namespace kelpie::lab {
namespace {

constexpr std::size_t kTurn = 25;  // updates of one solver before it is the other's turn
constexpr std::size_t kFewInputs = 3;
constexpr std::size_t kBatch = 16;  // calls too short for the clock are timed together

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

}  // namespace

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

}  // namespace kelpie::lab
