// SPDX-License-Identifier: Apache-2.0
#include "autopilot/parameter_keeper.hpp"

#include <gtest/gtest.h>

#include "autopilot/tuning.hpp"

namespace kelpie::parameter_keeper_test {
namespace {

using autopilot::kTuning;
using autopilot::ParameterKeeper;
using Time = ParameterKeeper::Time;

TEST(ParameterKeeper, WaitsForEachAnswerAndThenAsksForTheMotorsDirection) {
  ParameterKeeper keeper({4});
  const Time now{};
  EXPECT_EQ(keeper.next_request(now), "SERVO4_FUNCTION");
  EXPECT_EQ(keeper.next_request(now), std::nullopt);
  keeper.hear("SERVO4_FUNCTION", 33);
  EXPECT_EQ(keeper.next_request(now), "MOT_1_DIRECTION");
  keeper.hear("MOT_1_DIRECTION", 1);
  EXPECT_EQ(keeper.next_request(now), "FRAME_CONFIG");
  keeper.hear("FRAME_CONFIG", 2);
  EXPECT_EQ(keeper.next_request(now + std::chrono::hours(1)), std::nullopt);
  EXPECT_TRUE(keeper.faults().empty());
}

TEST(ParameterKeeper, ASilentVehicleIsAskedAFewTimesAndThenToldOf) {
  ParameterKeeper keeper({1, 2});
  Time now{};
  int requests = 0;
  for (int i = 0; i < 1000; ++i, now += kTuning.between_parameters) {
    requests += keeper.next_request(now) ? 1 : 0;
  }
  EXPECT_EQ(requests, 3 * kTuning.most_asked);
  ASSERT_EQ(keeper.faults().size(), 1U);
  EXPECT_EQ(keeper.faults()[0],
            "the vehicle does not tell its parameters SERVO1_FUNCTION, SERVO2_FUNCTION, "
            "FRAME_CONFIG");
}

TEST(ParameterKeeper, WithoutOutputsNothingIsAskedFor) {
  EXPECT_EQ(ParameterKeeper({}).next_request(Time{}), std::nullopt);
}

}  // namespace
}  // namespace kelpie::parameter_keeper_test
