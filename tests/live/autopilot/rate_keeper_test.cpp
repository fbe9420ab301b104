// SPDX-License-Identifier: Apache-2.0
#include "autopilot/rate_keeper.hpp"

#include <gtest/gtest.h>

#include <map>

namespace kelpie::rate_keeper_test {
namespace {

using autopilot::RateKeeper;

// A vehicle in a time of its own; it answers at once, if at all.
class Rates : public ::testing::Test {
 protected:
  void pass(double seconds) {
    for (const int end = step_ + static_cast<int>(100.0 * seconds); step_ < end; ++step_) {
      now_ += std::chrono::milliseconds(10);
      for (const auto& [id, rate_hz] : rates_hz_) {
        if (rate_hz > 0.0 && step_ % static_cast<int>(100.0 / rate_hz) == 0) {
          keeper_.count_message(id, now_);
        }
      }
      if (const auto wanted = keeper_.next_request(now_)) {
        ++asked_[wanted->id];
        if (obeys_) {
          rates_hz_[wanted->id] = wanted->rate_hz;
        }
        if (answers_) {
          keeper_.acknowledge(obeys_ ? RateKeeper::kAccepted : 3, now_);
        }
      }
    }
  }

  RateKeeper keeper_{{{.name = "ATTITUDE", .id = 30, .rate_hz = 20.0},
                      {.name = "SERVO_OUTPUT_RAW", .id = 36, .rate_hz = 20.0}}};
  RateKeeper::Time now_;
  int step_ = 0;
  std::map<std::uint32_t, double> rates_hz_{{30, 4.0}, {36, 2.0}};
  std::map<std::uint32_t, int> asked_;
  bool obeys_ = true;
  bool answers_ = true;
};

TEST_F(Rates, AreAskedForOnceWhereTheVehicleObeys) {
  pass(30.0);
  EXPECT_EQ(asked_, (std::map<std::uint32_t, int>{{30, 1}, {36, 1}}));
  EXPECT_TRUE(keeper_.faults().empty());
}

TEST_F(Rates, AreAskedForAgainWhereTheyFallBack) {
  pass(10.0);
  rates_hz_[36] = 2.0;  // the autopilot has begun anew
  pass(20.0);
  EXPECT_EQ(asked_[30], 1);
  EXPECT_EQ(asked_[36], 2);
  EXPECT_TRUE(keeper_.faults().empty());
}

TEST_F(Rates, ThatTheVehicleRefusesAreSaid) {
  obeys_ = false;
  pass(30.0);
  const std::vector<std::string> faults = keeper_.faults();
  ASSERT_EQ(faults.size(), 4U);
  EXPECT_EQ(faults[2], "SERVO_OUTPUT_RAW comes at 2.0 Hz; 20 Hz are asked for");
  EXPECT_EQ(faults[3], "SERVO_OUTPUT_RAW: the vehicle refuses to send it at 20 Hz (unsupported)");
  EXPECT_LT(asked_[36], 8);  // not with every message
  obeys_ = true;
  pass(20.0);
  EXPECT_TRUE(keeper_.faults().empty());
}

TEST_F(Rates, AVehicleThatNeverAnswersIsAskedForAllOfThem) {
  answers_ = false;
  pass(10.0);
  EXPECT_EQ(asked_.size(), 2U);
  EXPECT_TRUE(keeper_.faults().empty());
}

TEST_F(Rates, AMessageThatDoesNotComeIsSaid) {
  obeys_ = false;
  answers_ = false;
  rates_hz_[36] = 0.0;
  pass(20.0);
  ASSERT_EQ(keeper_.faults().size(), 2U);
  EXPECT_EQ(keeper_.faults()[1], "SERVO_OUTPUT_RAW doesn't come; 20 Hz are asked for");
}

}  // namespace
}  // namespace kelpie::rate_keeper_test
