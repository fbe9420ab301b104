// SPDX-License-Identifier: Apache-2.0
#include "log/dataset.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::joined_test {
namespace {

using log::Dataset;
using testing::message_of;

Dataset log_of(const std::string& source, std::vector<double> times_s) {
  Dataset data;
  data.source = source;
  data.input_names = {"u"};
  data.target_names = {"udot"};
  data.inputs.assign(times_s.size(), 1.0);
  data.targets.assign(times_s.size(), 2.0);
  data.configurations.assign(times_s.size(), 3);
  data.rows_read = times_s.size() + 1;
  data.rows_skipped = 1;
  data.rate_hz = 2.0;
  data.times_s = std::move(times_s);
  return data;
}

TEST(Joined, AClockThatGoesOnStaysAsItIsAndOneThatBeginsAgainFollowsAMinuteLater) {
  const Dataset all = log::joined({log_of("a.csv", {10.0, 10.5}), log_of("b.csv", {11.0, 11.5}),
                                   log_of("c.csv", {0.0, 0.5}), log_of("d.csv", {5000.0, 5000.5})});
  EXPECT_EQ(all.times_s, (std::vector{10.0, 10.5, 11.0, 11.5, 71.5, 72.0, 5000.0, 5000.5}));
  EXPECT_EQ(all.source, "a.csv, b.csv, c.csv, d.csv");
  EXPECT_EQ(all.rows(), 8U);
  EXPECT_EQ(all.inputs.size(), 8U);
  EXPECT_EQ(all.targets.size(), 8U);
  EXPECT_EQ(all.configurations.size(), 8U);
  EXPECT_EQ(all.rows_read, 12U);
  EXPECT_EQ(all.rows_skipped, 4U);
}

TEST(Joined, OtherColumnsRatesAndMarksAreRefusedNamingTheLog) {
  const auto refusal = [](auto change) {
    Dataset other = log_of("b.csv", {0.0, 0.5});
    change(other);
    return message_of<InputError>([&] { log::joined({log_of("a.csv", {0.0, 0.5}), other}); });
  };
  EXPECT_EQ(refusal([](Dataset& d) { d.input_names = {"v"}; }),
            "b.csv: inputs: are v; the first log has u");
  EXPECT_EQ(refusal([](Dataset& d) { d.target_names = {"vdot"}; }),
            "b.csv: targets: are vdot; the first log has udot");
  EXPECT_EQ(refusal([](Dataset& d) { d.rate_hz = 4.0; }),
            "b.csv: rate: is 4 Hz; the first log has 2 Hz");
  EXPECT_EQ(refusal([](Dataset& d) {
              d.held_out = {true, false};
            }),
            "b.csv: held-out rows: are marked by a column in some of the logs only");
  EXPECT_EQ(refusal([](Dataset& d) { d.rate_hz = 2.1; }), "");
}

}  // namespace
}  // namespace kelpie::joined_test
