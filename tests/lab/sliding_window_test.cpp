// SPDX-License-Identifier: Apache-2.0
#include "lab/sliding_window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kelpie/core/random.hpp"
#include "lab/offline_svr.hpp"

namespace kelpie::sliding_window_test {
namespace {

struct Sample {
  std::vector<double> z;
  double y = 0.0;
};

std::vector<Sample> made_up(std::size_t samples) {
  RandomStream random(5, "window");
  std::vector<Sample> stream(samples);
  for (Sample& sample : stream) {
    sample.z = {random.normal(), random.normal()};
    sample.y = std::sin(sample.z[0]) + 0.3 * sample.z[1] + 0.1 * random.normal();
  }
  return stream;
}

OnlineSvrSettings small_settings() {
  OnlineSvrSettings settings;
  settings.buffer = 50;
  settings.epsilon = 0.05;
  settings.gamma = 0.4;
  return settings;
}

SvrFunction function_of(const lab::SlidingWindow& window, const OnlineSvrSettings& settings) {
  SvrFunction function({SquaredExponential(settings.gamma), 2}, window.samples().capacity());
  function.assign(window.samples(), window.problem().beta(), window.problem().kkt().bias());
  return function;
}

// Whoever solves it, it is the problem of the last fifty samples: LIBSVM's answer from scratch is
// the same function.
TEST(SlidingWindow, HoldsTheLastSamplesAndTheirSolutionWhoeverSolvesIt) {
  const std::vector<Sample> stream = made_up(200);
  for (const SolverKind solver : {SolverKind::path, SolverKind::smo}) {
    for (const Storage storage : {Storage::float64, Storage::float32}) {
      OnlineSvrSettings settings = small_settings();
      settings.solver = solver;
      settings.storage = storage;
      settings.tolerance = 1e-6;
      lab::SlidingWindow window(2, settings);
      for (const Sample& sample : stream) {
        EXPECT_TRUE(window.step(sample.z, sample.y).converged);
      }
      SampleStore last(2, 50);
      std::vector<double> targets;
      for (std::size_t i = 150; i < 200; ++i) {
        last.push_back(stream[i].z);
        targets.push_back(stream[i].y);
      }
      std::vector<double> held(window.problem().targets().begin(),
                               window.problem().targets().end());
      std::vector<double> expected = targets;
      std::ranges::sort(held);
      std::ranges::sort(expected);
      EXPECT_EQ(held, expected);
      lab::OfflineSvrSettings same;
      same.gamma = settings.gamma;
      same.c = settings.c;
      same.epsilon = settings.epsilon;
      same.tolerance = settings.tolerance;
      const SvrFunction oracle = lab::train_by_libsvm(last, targets, same);
      const SvrFunction function = function_of(window, settings);
      for (std::size_t i = 150; i < 200; ++i) {
        EXPECT_NEAR(function(stream[i].z), oracle(stream[i].z), 2e-4);
      }
    }
  }
}

TEST(SlidingWindow, GoesOnWithSmoFromWhereItIs) {
  const std::vector<Sample> stream = made_up(120);
  lab::SlidingWindow path(2, small_settings());
  for (std::size_t i = 0; i < 100; ++i) {
    path.step(stream[i].z, stream[i].y);
  }
  lab::SlidingWindow smo = path;
  smo.switch_to_smo();
  EXPECT_GT(path.free_samples(), 0U);
  EXPECT_EQ(smo.free_samples(), 0U);
  for (std::size_t i = 100; i < 120; ++i) {
    path.step(stream[i].z, stream[i].y);
    smo.step(stream[i].z, stream[i].y);
  }
  EXPECT_NEAR(objective(path.problem()), objective(smo.problem()),
              2e-3 * std::abs(objective(path.problem())));
  EXPECT_LE(kkt_afresh(path.problem()).gap(), 1e-9);
  EXPECT_LE(kkt_afresh(smo.problem()).gap(), 1.001e-3);
}

}  // namespace
}  // namespace kelpie::sliding_window_test
