// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "alignment/late_log.hpp"
#include "kelpie/alignment/alignment.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "support.hpp"

namespace kelpie::lag_intervals_test {
namespace {

// A vehicle at 10 Hz whose two rotors follow their commands in lags of their own.
struct SluggishLog : testing::TwoAxisLog {
  static constexpr double kLagN = 0.8;
  static constexpr double kLagM = 1.5;

  SluggishLog(std::uint64_t seed, double noise, std::size_t size = 1500) {
    RandomStream random(seed, "drive");
    double u = 0.0;
    double v = 0.0;
    double phase = 0.0;
    double slow = 0.0;
    double rotor_n = 0.0;
    double rotor_m = 10.0;
    double n = 0.0;
    double m = 10.0;
    for (std::size_t i = 0; i < size; ++i) {
      phase += random.uniform(0.02, 0.2);
      slow += random.uniform(0.02, 0.15);
      const double n_before = std::exchange(n, 10.0 * std::sin(phase));
      const double m_before = std::exchange(m, 10.0 * std::cos(slow));
      rotor_n += -std::expm1(-0.1 / kLagN) * (0.5 * (n_before + n) - rotor_n);
      rotor_m += -std::expm1(-0.1 / kLagM) * (0.5 * (m_before + m) - rotor_m);
      const double udot = 0.01 * rotor_n * std::abs(rotor_n) - 2.0 * u * std::abs(u) - 0.3 * u;
      const double vdot = 0.02 * rotor_m * std::abs(rotor_m) - 3.0 * v * std::abs(v) - 0.5 * u * v;
      add({u, v, n, m}, {udot + noise * random.normal(), vdot + noise * random.normal()});
      u += 0.1 * udot;
      v += 0.1 * vdot;
    }
  }
};

Alignment guess(double lag_n, double lag_m) {
  return {.commands = {"n", "m"}, .actuators = {{.lag_s = lag_n}, {.lag_s = lag_m}}};
}

TEST(LagIntervals, HoldTheTruthAboutAsOftenAsPromised) {
  int held = 0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SluggishLog log(seed, 0.2);
    for (const LagInterval& found : lag_intervals(log.problem(), guess(0.7, 1.6))) {
      const double truth = found.command == "n" ? SluggishLog::kLagN : SluggishLog::kLagM;
      held += found.low_s <= truth && truth <= found.high_s ? 1 : 0;
      ++count;
    }
  }
  ASSERT_EQ(count, 40);
  EXPECT_GE(held, 34);
}

TEST(LagIntervals, AreNarrowerWithLessNoise) {
  const auto width = [](double noise) {
    const SluggishLog log(3, noise);
    const LagInterval found = lag_intervals(log.problem(), guess(0.8, 1.5)).front();
    EXPECT_LE(found.low_s, found.lag_s);
    EXPECT_GE(found.high_s, found.lag_s);
    return found.high_s - found.low_s;
  };
  EXPECT_LT(width(0.05), 0.5 * width(0.5));
}

TEST(LagIntervals, HaveNoEndWhereALogTellsNothing) {
  SluggishLog log(4, 0.1);
  for (std::size_t row = 0; row < log.rows.size(); ++row) {
    log.inputs[4 * row + 2] = 3.0;  // never moves
  }
  const std::vector<LagInterval> found = lag_intervals(log.problem(), guess(0.8, 1.5));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].low_s, 0.0);
  EXPECT_TRUE(std::isinf(found[0].high_s));
}

TEST(LagIntervals, AreOfCommandsWithALagWhateverTheirOrder) {
  const SluggishLog log(5, 0.1);
  EXPECT_TRUE(lag_intervals(log.problem(), {}).empty());
  EXPECT_TRUE(lag_intervals(log.problem(), guess(0.0, 0.0)).empty());
  const Alignment other{.commands = {"m", "n"}, .actuators = {{.lag_s = 1.5}, {.lag_s = 0.8}}};
  const std::vector<LagInterval> found = lag_intervals(log.problem(), guess(0.8, 1.5));
  const std::vector<LagInterval> same = lag_intervals(log.problem(), other);
  ASSERT_EQ(found.size(), same.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_EQ(found[k].command, same[k].command);
    EXPECT_EQ(found[k].low_s, same[k].low_s);
    EXPECT_EQ(found[k].high_s, same[k].high_s);
  }
  Alignment wrong = guess(0.8, 1.5);
  wrong.commands[1] = "x";
  EXPECT_EQ(testing::message_of<InputError>([&] { lag_intervals(log.problem(), wrong); }),
            "x: is no input");
}

}  // namespace
}  // namespace kelpie::lag_intervals_test
