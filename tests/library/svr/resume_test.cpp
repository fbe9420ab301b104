// SPDX-License-Identifier: Apache-2.0
// A learner saved and loaded goes on to the last bit as the one that never stopped.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "kelpie/svr/online_svr.hpp"
#include "kelpie/svr/resources.hpp"
#include "learner/streams.hpp"
#include "saved_state.hpp"

namespace kelpie::resume_test {
namespace {

using testing::load;
using testing::Sample;
using testing::saved;
using testing::wandering_stream;

using Learner = std::unique_ptr<OnlineSvr>;

OnlineSvrSettings small_settings() {
  OnlineSvrSettings settings;
  settings.buffer = 60;
  settings.gamma = 0.5;
  settings.epsilon = 0.02;
  settings.c = 10.0;
  settings.xi = 0.99;
  settings.outlier_factor = 3.0;
  settings.anchors = 10;
  return settings;
}

// Two vehicles, one after the other, with spikes; every sample has three terms as well, so that
// kernel rows are summed four, two and one term at a time.
std::vector<Sample> stream_with_terms(std::size_t samples) {
  std::vector<Sample> stream = wandering_stream(1, samples, 0.05);
  const std::vector<Sample> after = wandering_stream(2, samples, 0.05, 1, stream.back().t);
  stream.insert(stream.end(), after.begin(), after.end());
  for (std::size_t i = 0; i < stream.size(); ++i) {
    std::vector<double>& z = stream[i].z;
    const double a = z[0];
    const double b = z[1];
    z.insert(z.end(), {a * std::abs(a), b * std::abs(b), a * b, a, b});
    stream[i].y += i % 50 == 7 ? 20.0 : 0.0;
  }
  return stream;
}

Learner make(const OnlineSvrSettings& settings, const Budget& budget = {}) {
  auto learner = std::make_unique<OnlineSvr>(2, settings, 5);
  learner->limit(budget);
  return learner;
}

std::vector<double> numbers_of(const Decision& d) {
  return {static_cast<double>(d.verdict),
          d.prediction.value,
          d.had_model ? 1.0 : 0.0,
          d.similarity,
          static_cast<double>(d.outliers),
          static_cast<double>(d.forgotten),
          static_cast<double>(d.released),
          static_cast<double>(d.iterations),
          d.kkt_gap,
          d.published ? 1.0 : 0.0,
          d.rejected_by_tolerance ? 1.0 : 0.0,
          d.unfinished ? 1.0 : 0.0,
          static_cast<double>(d.fallbacks)};
}

// A second learner runs beside the first and is put away and taken up again at random moments.
Tally expect_same_life(const OnlineSvrSettings& settings, const Budget& budget = {}) {
  const std::vector<Sample> stream = stream_with_terms(500);
  RandomStream random(7, "stops");
  Learner whole = make(settings, budget);
  Learner broken = make(settings, budget);
  for (std::size_t i = 0; i < stream.size(); ++i) {
    if (random.below(12) == 0) {
      const std::string bytes = saved(*broken);
      EXPECT_EQ(bytes, saved(*whole)) << "sample " << i;
      broken = make(settings, budget);
      load(*broken, bytes);
      EXPECT_EQ(saved(*broken), bytes) << "sample " << i;
    }
    const Sample& sample = stream[i];
    EXPECT_EQ(numbers_of(whole->update(sample.z, sample.y, sample.t)),
              numbers_of(broken->update(sample.z, sample.y, sample.t)))
        << "sample " << i;
    const double a = whole->predict(stream[(i * 31) % stream.size()].z);
    const double b = broken->predict(stream[(i * 31) % stream.size()].z);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a), std::bit_cast<std::uint64_t>(b)) << "sample " << i;
    if (::testing::Test::HasFailure()) {
      break;
    }
  }
  return whole->status().tally;
}

TEST(Resume, EverySolverAndStorageGoesOnToTheLastBit) {
  for (const SolverKind solver : {SolverKind::path, SolverKind::smo}) {
    for (const Storage storage : {Storage::float64, Storage::float32}) {
      OnlineSvrSettings settings = small_settings();
      settings.solver = solver;
      settings.storage = storage;
      settings.max_iterations = 2000;
      const Tally tally = expect_same_life(settings);
      EXPECT_GT(tally.forgotten, 20);
      EXPECT_GT(tally.outliers, 5);
    }
  }
}

TEST(Resume, EveryRuleGoesOnToTheLastBit) {
  OnlineSvrSettings settings = small_settings();
  settings.outlier = OutlierRule::iqr;
  settings.forget = ForgetRule::fifo;
  settings.epsilon = 0.0;
  expect_same_life(settings);
  settings.outlier = OutlierRule::none;
  settings.forget = ForgetRule::paper;
  settings.epsilon = 0.1;
  expect_same_life(settings);
}

TEST(Resume, WorkThatABudgetLeftUndoneIsGoneOnWith) {
  for (const SolverKind solver : {SolverKind::path, SolverKind::smo}) {
    OnlineSvrSettings settings = small_settings();
    settings.solver = solver;
    EXPECT_GT(expect_same_life(settings, Budget(12)).unfinished, 20);
  }
}

// Rounding above the tolerance: the path gives up now and then, and SMO stays unfinished.
TEST(Resume, AFallbackGoesOnToTheLastBit) {
  OnlineSvrSettings settings = small_settings();
  settings.tolerance = 1e-17;
  settings.max_iterations = 20;
  EXPECT_GT(expect_same_life(settings).fallbacks, 10);
}

// Numbers that grow as long as a learner lives stay loadable.
TEST(Resume, AfterALongLifeItStillCanBeSaved) {
  OnlineSvrSettings settings = small_settings();
  settings.buffer = 12;
  Learner learner = make(settings);
  for (int round = 0; round < 6; ++round) {
    for (const Sample& sample : stream_with_terms(500)) {
      learner->update(sample.z, sample.y, sample.t + 300.0 * round);
    }
  }
  const std::string bytes = saved(*learner);
  Learner other = make(settings);
  load(*other, bytes);
  EXPECT_EQ(saved(*other), bytes);
}

// Whatever a state says: it is refused, or the learner that it makes lives on without harm. The
// sanitizers watch.
TEST(Resume, ACraftedStateIsRefusedOrHarmless) {
  OnlineSvrSettings settings = small_settings();
  settings.buffer = 20;
  settings.anchors = 5;
  settings.max_iterations = 50;
  const std::vector<Sample> stream = stream_with_terms(60);
  Learner learner = make(settings, Budget(30));
  for (std::size_t i = 0; i < 90; ++i) {
    learner->update(stream[i].z, stream[i].y, stream[i].t);
  }
  const std::string good = saved(*learner);
  RandomStream random(3, "craft");
  int refused = 0;
  int taken = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    std::string bytes = good;
    for (std::uint64_t k = 0; k <= random.below(4); ++k) {
      const std::size_t at = random.below(bytes.size() / 8) * 8;
      const std::array<std::uint64_t, 4> values{
          random.below(30), std::bit_cast<std::uint64_t>(1e300),
          std::bit_cast<std::uint64_t>(-1e-300), ~random.below(3)};
      const std::uint64_t value = values[random.below(4)];
      for (std::size_t i = 0; i < 8; ++i) {
        bytes[at + i] = static_cast<char>(static_cast<unsigned char>(value >> (8 * i)));
      }
    }
    Learner crafted = make(settings, Budget(30));
    try {
      load(*crafted, bytes);
    } catch (const InputError&) {
      ++refused;
      continue;
    }
    ++taken;
    for (std::size_t i = 90; i < 110; ++i) {
      crafted->update(stream[i].z, stream[i].y, stream[i].t);
      crafted->predict(stream[i].z);
    }
  }
  EXPECT_GT(refused, 100);
  EXPECT_GT(taken, 100);
}

TEST(Resume, EveryTruncationIsRefused) {
  OnlineSvrSettings settings = small_settings();
  settings.buffer = 6;
  Learner learner = make(settings);
  for (const Sample& sample : stream_with_terms(20)) {
    learner->update(sample.z, sample.y, sample.t);
  }
  const std::string bytes = saved(*learner);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THROW(load(*make(settings), bytes.substr(0, size)), InputError) << size;
  }
  EXPECT_THROW(load(*make(settings), bytes + "x"), InputError);
}

}  // namespace
}  // namespace kelpie::resume_test
