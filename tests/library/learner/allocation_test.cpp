// SPDX-License-Identifier: Apache-2.0
// The real-time contract: the memory of a learner is known before it is made, and is all it ever
// asks for.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "allocation_count.hpp"
#include "kelpie/learner/recursive_least_squares.hpp"
#include "kelpie/svr/online_svr.hpp"
#include "kelpie/svr/resources.hpp"
#include "learner/streams.hpp"
#include "saved_state.hpp"

namespace kelpie::allocation_test {
namespace {

using testing::allocated_bytes;
using testing::allocations;
using testing::Sample;
using testing::wandering_stream;

static_assert(noexcept(std::declval<OnlineSvr&>().update({}, 0.0, 0.0)));
static_assert(noexcept(std::declval<const OnlineSvr&>().predict({})));

// All that an update can run into: a full buffer, a vehicle that changes, outliers, duplicates,
// contradictions, samples that are no numbers.
std::vector<Sample> hard_stream() {
  std::vector<Sample> stream = wandering_stream(1, 700, 0.1);
  const std::vector<Sample> changed = wandering_stream(2, 700, 0.1, 1, stream.back().t);
  stream.insert(stream.end(), changed.begin(), changed.end());
  for (std::size_t i = 0; i < stream.size(); ++i) {
    if (i % 50 == 7) {
      stream[i].y += 20.0;
    } else if (i % 10 == 3) {
      stream[i].z = stream[i - 1].z;
    } else if (i % 97 == 5) {
      stream[i].y = std::nan("");
    }
  }
  return stream;
}

OnlineSvrSettings hard_settings() {
  OnlineSvrSettings settings;
  settings.buffer = 60;
  settings.gamma = 0.5;
  settings.epsilon = 0.02;
  settings.c = 10.0;
  settings.fine = 0.5;
  settings.xi = 0.99;
  settings.outlier_factor = 3.0;
  settings.anchors = 10;
  return settings;
}

Tally expect_no_allocation(const OnlineSvrSettings& settings, const Budget& budget,
                           const std::string& what) {
  const std::vector<Sample> stream = hard_stream();
  OnlineSvr learner(2, settings);
  learner.limit(budget);
  const std::size_t before = allocations;
  double sum = 0.0;
  for (const Sample& sample : stream) {
    learner.update(sample.z, sample.y, sample.t);
    sum += learner.predict(sample.z);
  }
  const Tally tally = learner.status().tally;
  EXPECT_EQ(allocations - before, 0U) << what;
  EXPECT_TRUE(std::isfinite(sum)) << what;
  EXPECT_GT(tally.forgotten, 20) << what;
  EXPECT_GT(tally.invalid, 5) << what;
  EXPECT_TRUE(settings.outlier == OutlierRule::none || tally.outliers > 5) << what;
  return tally;
}

TEST(RealTime, AnUpdateAndAPredictionAllocateNothing) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  for (const SolverKind solver : {SolverKind::path, SolverKind::smo}) {
    for (const Storage storage : {Storage::float64, Storage::float32}) {
      for (const OutlierRule outlier : {OutlierRule::none, OutlierRule::iqr, OutlierRule::robust}) {
        for (const ForgetRule forget : {ForgetRule::fifo, ForgetRule::paper, ForgetRule::age}) {
          OnlineSvrSettings settings = hard_settings();
          settings.solver = solver;
          settings.storage = storage;
          settings.outlier = outlier;
          settings.forget = forget;
          const std::string what = "solver " + std::to_string(static_cast<int>(solver)) +
                                   ", storage " + std::to_string(static_cast<int>(storage)) +
                                   ", outlier " + std::to_string(static_cast<int>(outlier)) +
                                   ", forget " + std::to_string(static_cast<int>(forget));
          expect_no_allocation(settings, Budget(), what);
        }
      }
    }
  }
}

TEST(RealTime, LeastSquaresAllocateNothing) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  const std::vector<std::string> inputs{"u", "n"};
  RecursiveLeastSquares learner(inputs, {.velocities = 1, .lambda = 0.99, .huber = 3.0});
  const std::vector<Sample> stream = hard_stream();
  const std::size_t before = allocations;
  for (const Sample& sample : stream) {
    learner.update(sample.z, sample.y, sample.t);
    learner.predict(sample.z);
  }
  EXPECT_EQ(allocations - before, 0U);
}

TEST(RealTime, ABudgetThatRunsOutAllocatesNothing) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  for (const SolverKind solver : {SolverKind::path, SolverKind::smo}) {
    OnlineSvrSettings settings = hard_settings();
    settings.solver = solver;
    settings.outlier = OutlierRule::none;
    EXPECT_GT(expect_no_allocation(settings, Budget(20), "budget").unfinished, 10);
  }
}

// A learner that was loaded keeps the capacity it was made with.
TEST(RealTime, ALoadedLearnerAllocatesNothing) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  const std::vector<Sample> stream = hard_stream();
  OnlineSvr saved(2, hard_settings());
  for (std::size_t i = 0; i < 30; ++i) {
    saved.update(stream[i].z, stream[i].y, stream[i].t);
  }
  OnlineSvr loaded(2, hard_settings());
  testing::load(loaded, testing::saved(saved));
  const std::size_t before = allocations;
  for (std::size_t i = 30; i < stream.size(); ++i) {
    loaded.update(stream[i].z, stream[i].y, stream[i].t);
  }
  EXPECT_EQ(allocations - before, 0U);
  EXPECT_GT(loaded.status().tally.forgotten, 20);
}

// The fallback is taken where the path can't reach the tolerance, rounding being above it.
TEST(RealTime, AFallbackAllocatesNothing) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  OnlineSvrSettings settings = hard_settings();
  settings.tolerance = 1e-17;
  settings.max_iterations = 50;
  settings.outlier = OutlierRule::none;
  const std::vector<Sample> stream = hard_stream();
  OnlineSvr learner(2, settings);
  const std::size_t before = allocations;
  for (const Sample& sample : stream) {
    learner.update(sample.z, sample.y, sample.t);
  }
  EXPECT_EQ(allocations - before, 0U);
  EXPECT_GT(learner.status().tally.fallbacks, 10);
}

TEST(RealTime, MemoryIsKnownBeforehand) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  for (const SolverKind solver : {SolverKind::path, SolverKind::smo}) {
    for (const Storage storage : {Storage::float64, Storage::float32}) {
      for (const int buffer : {100, 900, 2000}) {
        for (const std::size_t inputs : {2U, 6U, 64U}) {
          OnlineSvrSettings settings;
          settings.solver = solver;
          settings.storage = storage;
          settings.buffer = buffer;
          const std::size_t before = allocated_bytes;
          const auto learner = std::make_unique<OnlineSvr>(inputs, settings);
          const auto asked = static_cast<double>(allocated_bytes - before);
          const auto told = static_cast<double>(OnlineSvr::bytes(inputs, settings));
          EXPECT_NEAR(told / asked, 1.0, 0.02) << buffer << " samples, " << inputs << " inputs";
        }
      }
    }
  }
}

}  // namespace
}  // namespace kelpie::allocation_test
