// SPDX-License-Identifier: Apache-2.0
#include "study/diagnosis.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace kelpie::diagnosis_test {
namespace {

Finding settled(double since_s, const Cause& cause) {
  Finding finding;
  finding.since_s = since_s;
  finding.state = FindingState::named;
  finding.settled = true;
  finding.count = 1;
  finding.causes[0] = cause;
  return finding;
}

// A battery that sags is a change of every thruster.
TEST(ThrusterSinceStart, ChangedWithItsOwnLossesAndWithThoseOfAllThrusters) {
  const Cause third{.kind = CauseKind::thruster, .place = 3};
  const std::array findings{settled(100.0, third),
                            settled(200.0, {.kind = CauseKind::thruster, .place = 4}),
                            settled(300.0, {.kind = CauseKind::all_thrusters}),
                            settled(400.0, {.kind = CauseKind::sensor_bias, .place = 3})};
  EXPECT_EQ(study::since_the_start(third, {}, findings).changed_s, (std::vector{100.0, 300.0}));
}

// 0.5 of 0.8, each known to ± 0.1: errors of the factors add in squares.
TEST(ThrusterSinceStart, GivesTheShareOfTheLastMinuteOfTheShareBefore) {
  const Cause present{.place = 3, .size = 0.5, .lower = 0.4, .upper = 0.6};
  const std::array health{Cause{.place = 3, .size = 0.8, .lower = 0.7, .upper = 0.9}};
  const Cause share = study::since_the_start(present, health, {}).cause;
  EXPECT_DOUBLE_EQ(share.size, 0.4);
  EXPECT_NEAR(share.upper - share.lower, 2.0 * std::hypot(0.05, 0.08), 1e-12);
}

}  // namespace
}  // namespace kelpie::diagnosis_test
