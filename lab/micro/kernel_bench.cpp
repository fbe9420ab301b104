// SPDX-License-Identifier: Apache-2.0
// The kernel on its own: a row, a prediction, and what a plain loop would take for the row.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "kelpie/core/random.hpp"
#include "svr/squared_exponential.hpp"

namespace kelpie {
namespace {

constexpr double kGamma = 0.15;

struct Samples {
  std::vector<double> rows;  // one sample after the other
  SampleStore store;
  std::vector<double> z;
  std::vector<double> out;
};

Samples made_up(const benchmark::State& state) {
  const auto n = static_cast<std::size_t>(state.range(0));
  const auto d = static_cast<std::size_t>(state.range(1));
  RandomStream random(1, "bench");
  Samples samples{{}, SampleStore(d, n), std::vector<double>(d), std::vector<double>(n)};
  for (std::size_t i = 0; i <= n; ++i) {
    for (double& value : samples.z) {
      value = random.normal();
    }
    if (i < n) {
      samples.store.push_back(samples.z);
      samples.rows.insert(samples.rows.end(), samples.z.begin(), samples.z.end());
    }
  }
  return samples;
}

void row(benchmark::State& state) {
  Samples samples = made_up(state);
  const SquaredExponential kernel(kGamma);
  for (auto _ : state) {
    kernel.row(samples.z, samples.store, samples.out);
    benchmark::DoNotOptimize(samples.out.data());
    benchmark::ClobberMemory();
  }
}

void plain_row(benchmark::State& state) {
  Samples samples = made_up(state);
  const std::size_t d = samples.z.size();
  for (auto _ : state) {
    for (std::size_t i = 0; i < samples.out.size(); ++i) {
      double square = 0.0;
      for (std::size_t k = 0; k < d; ++k) {
        square += std::pow(samples.rows[i * d + k] - samples.z[k], 2);
      }
      samples.out[i] = std::exp(-kGamma * square);
    }
    benchmark::DoNotOptimize(samples.out.data());
    benchmark::ClobberMemory();
  }
}

void expansion(benchmark::State& state) {
  Samples samples = made_up(state);
  const SquaredExponential kernel(kGamma);
  for (auto _ : state) {
    benchmark::DoNotOptimize(kernel.expansion(samples.z, samples.store, samples.out));
  }
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"samples", "inputs"})->ArgsProduct({{225, 900, 3600}, {3, 6, 48}});
}

BENCHMARK(row)->Apply(sizes);
BENCHMARK(plain_row)->Apply(sizes);
BENCHMARK(expansion)->Apply(sizes);

}  // namespace
}  // namespace kelpie
