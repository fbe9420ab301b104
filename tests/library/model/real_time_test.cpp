// SPDX-License-Identifier: Apache-2.0
// What include/README.md promises of a model in real time, at the door that users take.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "allocation_count.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/svr/resources.hpp"
#include "vehicle_stream.hpp"

namespace kelpie::real_time_test {
namespace {

using testing::Drive;

constexpr std::size_t kPart = 700;
constexpr std::size_t kStart = 120;  // samples after which every scale is known

ModelSettings small(const std::string& preset, const std::string& learner) {
  ModelSettings settings = ModelSettings::from_preset(preset, 2);
  settings.assign("learner", learner);
  settings.assign("buffer", "100");
  settings.assign("warmup", "50");
  return settings;
}

// The vehicle, another one, the first again, and then the first with larger commands.
Drive hard_drive() {
  Drive drive = testing::drive(9, 4 * kPart);
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    const std::size_t part = i / kPart;
    if (part == 1) {
      drive.y[i][0] = -drive.y[i][0];
      drive.y[i][1] = 100.0 - drive.y[i][1];
    } else if (part == 3) {
      drive.x[i][1] *= 5.0;
      drive.y[i][0] *= 5.0;
    } else if (i % 97 == 5) {
      drive.y[i][0] = std::nan("");
    } else if (i % 50 == 7) {
      drive.y[i][1] += 40.0;
    }
  }
  return drive;
}

// But for updates in which the units of the posterior's kernel move, or the model begins anew.
TEST(RealTime, NothingAllocatesOnceTheScaleIsKnown) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  const Drive drive = hard_drive();
  for (const auto& [preset, learner] :
       {std::pair("default", "posterior"), {"default", "svr"}, {"paper", "svr"}}) {
    DynamicsModel model(drive.inputs, drive.targets, small(preset, learner));
    std::array<double, 2> y{};
    std::array<double, 4> jacobian{};
    std::array<Prediction, 2> whole{};
    std::size_t before = 0;
    int new_units = 0;
    for (std::size_t i = 0; i < drive.x.size(); ++i) {
      const double unit = testing::units_of(model);
      if (i == kStart) {
        before = testing::allocations;
      }
      const std::size_t until_now = testing::allocations;
      model.update(drive.x[i], drive.y[i], 0.1 * static_cast<double>(i));
      if (i >= kStart && testing::units_of(model) != unit) {
        before += testing::allocations - until_now;
        ++new_units;
      }
      model.predict(drive.x[i], y);
      model.predict(drive.x[i], whole);
      model.predict_with_jacobian(drive.x[i], y, jacobian);
    }
    EXPECT_EQ(testing::allocations, before) << preset << ", " << learner;
    EXPECT_LE(new_units, learner == std::string("posterior") ? 30 : 0);
    if (std::string(learner) == "posterior") {
      EXPECT_GT(model.axis(0).status().tally.changes, 0);
      EXPECT_GT(model.axis(0).status().tally.recalls, 0);
    }
  }
}

// R² of the last quarter, one step ahead.
double late_r2(DynamicsModel& model, const Drive& drive, std::size_t axis) {
  double wrong = 0.0;
  double mean = 0.0;
  double squares = 0.0;
  const std::size_t from = 3 * drive.x.size() / 4;
  const auto count = static_cast<double>(drive.x.size() - from);
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    model.update(drive.x[i], drive.y[i], 0.1 * static_cast<double>(i));
    if (i >= from) {
      const double y = drive.y[i][axis];
      wrong += std::pow(y - model.decisions()[axis].prediction.value, 2);
      mean += y / count;
      squares += y * y;
    }
  }
  return 1.0 - wrong / (squares - count * mean * mean);
}

TEST(RealTime, ABudgetLeavesWorkToLaterUpdatesAndTheModelGood) {
  const Drive drive = testing::drive(9, 1200);
  DynamicsModel limited(drive.inputs, drive.targets, small("default", "svr"));
  limited.limit(Budget(3));
  EXPECT_GT(late_r2(limited, drive, 0), 0.98);
  const Status status = limited.axis(0).status();
  EXPECT_GT(status.tally.unfinished, 20);
  EXPECT_LT(status.kkt_gap, 1e-3);
  DynamicsModel free(drive.inputs, drive.targets, small("default", "svr"));
  late_r2(free, drive, 0);
  EXPECT_EQ(free.axis(0).status().tally.unfinished, 0);
}

// A deadline of the caller's own: here a clock that counts how often it is asked.
TEST(RealTime, ADeadlineBoundsTheWholeUpdate) {
  const Drive drive = testing::drive(9, 600);
  DynamicsModel model(drive.inputs, drive.targets, small("default", "posterior"));
  int asked = 0;
  model.limit(Budget(
      1'000'000, [](void* count) { return ++*static_cast<int*>(count) > 8; }, &asked));
  int most = 0;
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    asked = 0;
    model.update(drive.x[i], drive.y[i], 0.1 * static_cast<double>(i));
    most = std::max(most, i < kStart ? 0 : asked);
  }
  EXPECT_GT(most, 8);
  EXPECT_LT(most, 80);  // each of six solvers asks at every node of Algorithm 1
  EXPECT_TRUE(model.ready());
}

}  // namespace
}  // namespace kelpie::real_time_test
