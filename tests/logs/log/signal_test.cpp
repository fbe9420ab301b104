// SPDX-License-Identifier: Apache-2.0
#include "log/signal.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kelpie::signal_test {
namespace {

using Values = std::vector<double>;

TEST(Signal, IsPutInOrder) {
  log::Signal signal;
  signal.times_s = {0.0, 0.2, 0.1, 0.3, 0.3, 2.0};
  signal.values = {0, 2, 1, 3, 9, 7};
  log::sort_by_time(signal);
  EXPECT_EQ(signal.times_s, (Values{0.0, 0.1, 0.2, 0.3, 0.3, 2.0}));
  EXPECT_EQ(signal.values, (Values{0, 1, 2, 3, 9, 7}));
  EXPECT_EQ(signal.steps_back, 1U);
  EXPECT_DOUBLE_EQ(signal.longest_back_s, 0.1);
}

TEST(Signal, TheMedianStepPassesOverRepeatedStampsAndMissingValues) {
  log::Signal signal;
  signal.times_s = {0.0, 0.1, 0.1, 0.15, 0.2, 0.3, 5.0};
  signal.values = {0, 1, 1, std::nan(""), 2, 3, 4};
  EXPECT_NEAR(log::median_step_s(signal), 0.1, 1e-12);
  signal.times_s.resize(1);
  signal.values.resize(1);
  EXPECT_EQ(log::median_step_s(signal), 0.0);
}

}  // namespace
}  // namespace kelpie::signal_test
