// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/shared_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <thread>
#include <utility>
#include <vector>

#include "allocation_count.hpp"
#include "files/model_block.hpp"
#include "model/model_axis.hpp"
#include "vehicle_stream.hpp"

namespace kelpie::shared_model_test {
namespace {

using testing::Drive;

constexpr double kStep = 0.1;  // seconds

ModelSettings small() {
  ModelSettings settings = ModelSettings::from_preset("default", 2);
  settings.assign("buffer", "100");
  return settings;
}

SharedModel make(const Drive& drive) {
  return SharedModel(DynamicsModel(drive.inputs, drive.targets, small()));
}

TEST(SharedModel, SaysWhatTheModelSays) {
  const Drive drive = testing::drive(3, 700);
  SharedModel shared = make(drive);
  std::array<double, 2> a{};
  std::array<double, 2> b{};
  std::array<Prediction, 2> p{};
  std::array<Prediction, 2> q{};
  std::array<double, 4> slopes{};
  std::array<double, 4> same{};
  EXPECT_EQ(shared.predict(drive.x[0], a), 0);
  std::int64_t last = 0;
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    shared.update(drive.x[i], drive.y[i], kStep * static_cast<double>(i));
    const std::vector<double>& x = drive.x[(7 * i) % drive.x.size()];
    const std::int64_t number = shared.predict(x, a);
    if (!shared.model().ready()) {
      EXPECT_EQ(number, 0);
      continue;
    }
    EXPECT_EQ(number, last + 1);
    last = number;
    shared.model().predict(x, b);
    EXPECT_EQ(a, b);
    shared.predict(x, std::span<Prediction>(p), 0.3);
    shared.model().predict(x, std::span<Prediction>(q), 0.3);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(p[k].value, q[k].value);
      EXPECT_EQ(p[k].lower, q[k].lower);
      EXPECT_EQ(p[k].novelty, q[k].novelty);
      EXPECT_EQ(p[k].disturbance, q[k].disturbance);
      EXPECT_EQ(p[k].corrected_upper, q[k].corrected_upper);
    }
    shared.predict_with_jacobian(x, a, slopes);
    shared.model().predict_with_jacobian(x, b, same);
    EXPECT_EQ(a, b);
    EXPECT_EQ(slopes, same);
  }
  EXPECT_GT(last, 600);
  EXPECT_EQ(shared.passed_over(), 0);
}

TEST(SharedModel, AModelThatHasLearnedIsThereAtOnce) {
  const Drive drive = testing::drive(3, 200);
  DynamicsModel model(drive.inputs, drive.targets, small());
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    model.update(drive.x[i], drive.y[i], kStep * static_cast<double>(i));
  }
  const SharedModel shared(std::move(model));
  std::array<double, 2> y{};
  EXPECT_EQ(shared.predict(drive.x[0], y), 1);
}

// Each of them would take a picture away for good, if it kept its hold on it.
TEST(SharedModel, WrongCallsKeepNoPicture) {
  const Drive drive = testing::drive(4, 200);
  SharedModel shared = make(drive);
  std::array<double, 1> one{};
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    shared.update(drive.x[i], drive.y[i], kStep * static_cast<double>(i));
    if (shared.model().ready()) {
      EXPECT_THROW(shared.predict(drive.x[i], one), InputError);
    }
  }
  EXPECT_TRUE(shared.model().ready());
  EXPECT_EQ(shared.passed_over(), 0);
}

TEST(SharedModel, PublishingAndPredictingAllocateNothing) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  const Drive drive = testing::drive(9, 500);
  SharedModel shared = make(drive);
  const std::vector<Snapshot> capacity{shared.model().mechanisms(0).snapshot(),
                                       shared.model().mechanisms(1).snapshot()};
  const BlockLayout layout = BlockLayout::of(drive.inputs, drive.targets,
                                             shared.model().mechanisms(0).terms(), capacity, true);
  std::vector<std::uint64_t> words(layout.bytes() / sizeof(std::uint64_t));
  ModelBlock::clear(std::as_writable_bytes(std::span(words)), layout);
  shared.serve(std::as_writable_bytes(std::span(words)), drive.inputs, drive.targets);
  std::array<Prediction, 2> y{};
  std::size_t before = testing::allocations;
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    const double unit = testing::units_of(shared.model());
    const std::size_t until_now = testing::allocations;
    shared.update(drive.x[i], drive.y[i], kStep * static_cast<double>(i));
    if (i < 100 || testing::units_of(shared.model()) != unit) {
      before += testing::allocations - until_now;
    }
    shared.predict(drive.x[i], std::span<Prediction>(y));
  }
  EXPECT_EQ(testing::allocations, before);
  EXPECT_EQ(words[3], 491U);  // every row after the first 9 renewed the block
}

// Readers at full speed. What each of them was told by a picture is what the writer found when it
// published it: no reader ever sees half of one and half of another.
void expect_whole_models(const Drive& drive) {
  SharedModel shared = make(drive);
  const std::vector<double> x{0.2, 300.0};
  std::atomic<bool> going{true};
  using Told = std::map<std::int64_t, std::array<double, 2>>;
  const auto read = [&](Told& told) {
    std::array<double, 2> y{};
    while (going) {
      if (const std::int64_t number = shared.predict(x, y); number > 0) {
        const auto known = told.emplace(number, y).first;
        EXPECT_EQ(known->second, y) << number;
      }
    }
  };
  std::array<Told, 3> told;
  std::vector<std::thread> readers;
  readers.reserve(told.size());
  for (Told& one : told) {
    readers.emplace_back([&read, &one] { read(one); });
  }
  Told truth;
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    shared.update(drive.x[i], drive.y[i], kStep * static_cast<double>(i));
    std::array<double, 2> y{};
    if (const std::int64_t number = shared.predict(x, y); number > 0) {
      truth.emplace(number, y);
    }
  }
  going = false;
  for (std::thread& reader : readers) {
    reader.join();
  }
  EXPECT_GT(truth.size(), 100U);
  for (const Told& one : told) {
    EXPECT_FALSE(one.empty());
    for (const auto& [number, y] : one) {
      ASSERT_TRUE(truth.contains(number)) << number;
      EXPECT_EQ(truth[number], y) << number;
    }
  }
}

TEST(SharedModel, ReadersSeeWholeModelsAndNobodyWaits) {
  expect_whole_models(testing::drive(5, 600));
}

// The guard replaces axes, while readers predict.
TEST(SharedModel, ReadersSeeWholeModelsThroughGarbage) {
  Drive drive = testing::drive(5, 900);
  for (std::size_t i = 0; i < drive.y.size(); ++i) {
    if (i < 60 || (i >= 400 && i < 440)) {
      std::ranges::for_each(drive.y[i], [](double& target) { target *= 1e6; });
    }
  }
  expect_whole_models(drive);
}

}  // namespace
}  // namespace kelpie::shared_model_test
