// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "cli/command.hpp"

namespace kelpie::bench_test {
namespace {

using testing::Outcome;

class BenchCommand : public testing::CommandTest {};

TEST_F(BenchCommand, SoaksTheSolver) {
  const Outcome outcome = run("bench --soak 400");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("400 updates, 0 fallbacks"), std::string::npos) << outcome.out;
}

TEST_F(BenchCommand, TimesSingleUpdatesOfAModel) {
  const Outcome outcome = run("bench --updates 300 --budget 5");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("drives for 300 updates"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("≤ 7.5 ms"), std::string::npos) << outcome.out;
}

TEST_F(BenchCommand, RefusesWhatItCannotMeasure) {
  testing::expect_refused(run("bench"), "give --updates or --soak");
  testing::expect_refused(run("bench --soak -1"), "--soak");
  testing::expect_refused(run("bench --budget 5"), "--updates");
}

}  // namespace
}  // namespace kelpie::bench_test
