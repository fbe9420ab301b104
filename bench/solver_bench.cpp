// SPDX-License-Identifier: Apache-2.0
// A whole update of a sliding window, by each solver, on a made-up stream. `kelpie bench` measures
// on logs; this is for looking at one change of the code after another.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstddef>

#include "kelpie/core/random.hpp"
#include "kelpie/study/sliding_window.hpp"

namespace kelpie {
namespace {

class Stream {
 public:
  void update(SlidingWindow& window) {
    for (std::size_t k = 0; k < z_.size(); ++k) {
      phase_[k] += random_.uniform(0.02, 0.2);
      z_[k] = 1.4 * std::sin(phase_[k]);
    }
    const double y = std::sin(z_[0]) + 0.3 * z_[1] * std::abs(z_[1]) - 0.4 * z_[2] * z_[3] +
                     0.2 * z_[4] - 0.1 * z_[5] + 0.1 * random_.normal();
    benchmark::DoNotOptimize(window.step(z_, y));
  }

 private:
  RandomStream random_{1, "bench"};
  std::array<double, 6> phase_{0.0, 1.0, 2.0, 3.0, 4.0, 5.0};
  std::array<double, 6> z_{};
};

void update(benchmark::State& state, SolverKind solver, Storage storage) {
  OnlineSvrSettings settings;
  settings.buffer = static_cast<int>(state.range(0));
  settings.storage = storage;
  SlidingWindow window(6, settings);
  Stream stream;
  while (window.size() < static_cast<std::size_t>(settings.buffer)) {
    stream.update(window);
  }
  if (solver == SolverKind::smo) {
    window.switch_to_smo();
  }
  for (auto _ : state) {
    stream.update(window);
  }
}

BENCHMARK_CAPTURE(update, path, SolverKind::path, Storage::float64)->Arg(225)->Arg(900);
BENCHMARK_CAPTURE(update, path_float, SolverKind::path, Storage::float32)->Arg(225)->Arg(900);
BENCHMARK_CAPTURE(update, smo, SolverKind::smo, Storage::float64)->Arg(225)->Arg(900);

}  // namespace
}  // namespace kelpie
