// SPDX-License-Identifier: Apache-2.0
// A whole update of a sliding window, by each solver, on a made-up stream. `kelpie bench` measures
// on logs; this is for looking at one change of the code after another.
#include <benchmark/benchmark.h>

#include <cstddef>

#include "lab/sliding_window.hpp"
#include "lab/soak.hpp"

namespace kelpie {
namespace {

void step(lab::SlidingWindow& window, lab::SoakStream& stream) {
  const lab::SoakStream::Sample sample = stream.next();
  benchmark::DoNotOptimize(window.step(sample.z, sample.y));
}

void update(benchmark::State& state, SolverKind solver, Storage storage) {
  OnlineSvrSettings settings;
  settings.buffer = static_cast<int>(state.range(0));
  settings.storage = storage;
  lab::SlidingWindow window(lab::SoakStream::kInputs, settings);
  lab::SoakStream stream(1);
  while (window.size() < static_cast<std::size_t>(settings.buffer)) {
    step(window, stream);
  }
  if (solver == SolverKind::smo) {
    window.switch_to_smo();
  }
  for (auto _ : state) {
    step(window, stream);
  }
}

BENCHMARK_CAPTURE(update, path, SolverKind::path, Storage::float64)->Arg(225)->Arg(900);
BENCHMARK_CAPTURE(update, path_float, SolverKind::path, Storage::float32)->Arg(225)->Arg(900);
BENCHMARK_CAPTURE(update, smo, SolverKind::smo, Storage::float64)->Arg(225)->Arg(900);

}  // namespace
}  // namespace kelpie
