// SPDX-License-Identifier: Apache-2.0
#include "study/first_look.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "support.hpp"

namespace kelpie::first_look_test {
namespace {

// A vehicle with drag, driven by n, or a log whose n is of another vehicle.
log::Dataset drive(bool is_its_own) {
  log::Dataset data;
  data.source = "drive.csv";
  data.input_names = {"u", "n"};
  data.target_names = {"udot"};
  data.rate_hz = 10.0;
  RandomStream own(1, "own");
  RandomStream other(2, "other");
  double u = 0.0;
  double n = 0.0;
  double logged = 0.0;
  for (int k = 0; k < 2000; ++k) {
    if (k % 20 == 0) {
      n = own.uniform(-1.0, 1.0);
      logged = is_its_own ? n : other.uniform(-1.0, 1.0);
    }
    const double udot = n - u * std::abs(u) - 0.5 * u;
    data.inputs.insert(data.inputs.end(), {u, logged});
    data.targets.push_back(udot);
    data.times_s.push_back(0.1 * k);
    data.configurations.push_back(0);
    u += 0.1 * udot;
  }
  return data;
}

TEST(FirstLook, TellsWhetherCommandsBelongToTheVelocities) {
  const study::FirstLook own = study::first_look(drive(true));
  ASSERT_EQ(own.axes.size(), 1U);
  EXPECT_GT(own.axes[0].r2, 0.95);
  EXPECT_LT(own.axes[0].r2_without_commands, 0.5);
  const study::FirstLook other = study::first_look(drive(false));
  EXPECT_LT(other.axes[0].r2, other.axes[0].r2_without_commands + 0.05);
  EXPECT_EQ(other.rows, 2000U);
  EXPECT_EQ(other.held_out, 400U);
}

TEST(FirstLook, ALogTooShortToBeSplitIsRefused) {
  log::Dataset data = drive(true);
  data.inputs.resize(8);
  data.targets.resize(4);
  data.times_s.resize(4);
  data.configurations.resize(4);
  EXPECT_NE(testing::message_of<InputError>([&] { study::first_look(data); }).find("needs 25"),
            std::string::npos);
}

}  // namespace
}  // namespace kelpie::first_look_test
