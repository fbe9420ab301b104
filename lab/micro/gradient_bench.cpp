// SPDX-License-Identifier: Apache-2.0
// A prediction of three axes, without and with its Jacobian.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/core/random.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/motion/term_set.hpp"
#include "model/snapshot.hpp"

namespace kelpie {
namespace {

// Six inputs, three axes; nobody learned it, but it costs what a learned one does.
TrainedModel made_up(std::size_t support_vectors, const std::string& terms) {
  const std::vector<std::string> inputs{"u", "v", "r", "th1", "th2", "th3"};
  RandomStream random(1, "bench");
  TrainedModel model{
      inputs, ModelSettings::from_preset("default", 3), TermSet::from(terms, inputs, 3), {}};
  const MixedKernel kernel(0.15, {.s = 1.0, .fine = 0.3, .lambda = 0.1}, inputs.size(),
                           model.terms.size());
  for (const char* const target : {"udot", "vdot", "rdot"}) {
    SampleStore samples(kernel.dimension(), support_vectors);
    std::vector<double> sample(kernel.dimension());
    std::vector<double> beta(support_vectors);
    for (double& weight : beta) {
      for (double& value : sample) {
        value = random.normal();
      }
      samples.push_back(sample);
      weight = random.normal();
    }
    SvrFunction function(kernel, support_vectors);
    function.assign(samples, beta, 0.1);
    AxisScaling scaling{
        {std::vector<double>(6), Matrix(6, 6)}, {}, std::vector<double>(model.terms.size(), 1.0)};
    for (std::size_t i = 0; i < 6; ++i) {
      scaling.input.whitening(i, i) = 1.0;
    }
    model.axes.push_back({.name = target,
                          .scaling = scaling,
                          .function = {.members = {{"learner", 1.0, std::move(function)}}}});
  }
  return model;
}

TrainedModel model_of(const benchmark::State& state) {
  return made_up(static_cast<std::size_t>(state.range(0)), state.range(1) == 0 ? "none" : "fossen");
}

const std::vector<double> kInput{0.3, -0.1, 0.2, 0.5, -0.4, 0.1};

void predict(benchmark::State& state) {
  const TrainedModel model = model_of(state);
  std::vector<double> y(3);
  for (auto _ : state) {
    model.predict(kInput, y);
    benchmark::DoNotOptimize(y.data());
    benchmark::ClobberMemory();
  }
}

void predict_with_jacobian(benchmark::State& state) {
  const TrainedModel model = model_of(state);
  std::vector<double> y(3);
  std::vector<double> jacobian(18);
  for (auto _ : state) {
    model.predict_with_jacobian(kInput, y, jacobian);
    benchmark::DoNotOptimize(jacobian.data());
    benchmark::ClobberMemory();
  }
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"support_vectors", "terms"})->ArgsProduct({{300, 900}, {0, 1}});
}

BENCHMARK(predict)->Apply(sizes);
BENCHMARK(predict_with_jacobian)->Apply(sizes);

}  // namespace
}  // namespace kelpie
