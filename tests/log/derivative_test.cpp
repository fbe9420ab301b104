// SPDX-License-Identifier: Apache-2.0
#include "log/derivative.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "support.hpp"

namespace kelpie::derivative_test {
namespace {

using Values = std::vector<double>;

log::Signal sampled(const std::function<double(double)>& f, std::size_t count,
                    double jitter_s = 0.0) {
  log::Signal signal;
  RandomStream random(3, "stamps");
  for (std::size_t k = 0; k < count; ++k) {
    signal.times_s.push_back(0.05 * static_cast<double>(k) + jitter_s * random.uniform());
    signal.values.push_back(f(signal.times_s.back()));
  }
  return signal;
}

Values middle_of(std::size_t count) {
  Values at;
  for (std::size_t k = count / 3; k < 2 * count / 3; ++k) {
    at.push_back(0.05 * static_cast<double>(k) + 0.013);
  }
  return at;
}

TEST(Derivative, IsExactForPolynomialsUpToItsDegreeWhateverTheStamps) {
  for (const log::FilterWindow window : {log::FilterWindow::centred, log::FilterWindow::causal}) {
    for (int degree = 1; degree <= 4; ++degree) {
      const auto f = [&](double t) { return 2.0 - 3.0 * t + std::pow(t, degree); };
      const auto slope = [&](double t) { return -3.0 + degree * std::pow(t, degree - 1); };
      const log::Signal signal = sampled(f, 90, 0.02);
      const Values at = middle_of(90);
      const Values found = log::derivative(signal, at, {window, 0.6, degree}, 1.0);
      for (std::size_t k = 0; k < at.size(); ++k) {
        EXPECT_NEAR(found[k], slope(at[k]), 1e-9 * std::pow(at[k], degree) + 1e-9) << degree;
      }
    }
  }
}

// Savitzky and Golay's tables: five points, quadratic, first derivative.
TEST(Derivative, HasTheClassicWeights) {
  const Values centred = log::derivative_weights(Values{-2, -1, 0, 1, 2}, 2);
  const Values end = log::derivative_weights(Values{-4, -3, -2, -1, 0}, 2);
  const Values classic{-0.2, -0.1, 0.0, 0.1, 0.2};
  const Values classic_end{26.0 / 70, -27.0 / 70, -40.0 / 70, -13.0 / 70, 54.0 / 70};
  for (std::size_t i = 0; i < classic.size(); ++i) {
    EXPECT_NEAR(centred[i], classic[i], 1e-12);
    EXPECT_NEAR(end[i], classic_end[i], 1e-12);
  }
}

TEST(Derivative, StatesTheDelayThatARampOfAccelerationShows) {
  const log::Signal signal = sampled([](double t) { return 0.5 * t * t; }, 200);  // v' = t
  for (const log::DerivativeSettings& settings :
       {log::DerivativeSettings{log::FilterWindow::centred, 0.5, 1},
        log::DerivativeSettings{log::FilterWindow::centred, 0.5, 2},
        log::DerivativeSettings{log::FilterWindow::causal, 0.5, 1},
        log::DerivativeSettings{log::FilterWindow::causal, 0.5, 2}}) {
    const log::DerivativeInfo info = log::derivative_info(0.05, settings);
    const double found = log::derivative(signal, Values{5.0}, settings, 1.0).front();
    EXPECT_NEAR(5.0 - found, info.delay_s, 1e-9);
    const bool is_late = settings.window == log::FilterWindow::causal && settings.degree == 1;
    EXPECT_NEAR(info.delay_s, is_late ? 0.25 : 0.0, 1e-9);
    EXPECT_EQ(info.points, 11U);
  }
}

TEST(Derivative, StatesTheNoiseThatWhiteNoiseShows) {
  RandomStream random(11, "noise");
  const log::Signal noise = sampled([&](double) { return random.normal(); }, 20'000);
  for (const log::FilterWindow window : {log::FilterWindow::centred, log::FilterWindow::causal}) {
    const log::DerivativeSettings settings{window, 0.5, 2};
    double squares = 0.0;
    const Values at(noise.times_s.begin() + 20, noise.times_s.end() - 20);
    for (const double slope : log::derivative(noise, at, settings, 1.0)) {
      squares += slope * slope;
    }
    const double measured = std::sqrt(squares / static_cast<double>(at.size()));
    EXPECT_NEAR(measured / log::derivative_info(0.05, settings).noise_gain, 1.0, 0.05);
  }
  // As Savitzky and Golay have it for 11 points; looking back only costs.
  EXPECT_NEAR(log::derivative_info(0.05, {log::FilterWindow::centred, 0.5, 2}).noise_gain,
              std::sqrt(12.0 / (11.0 * 120.0)) / 0.05, 1e-9);
  EXPECT_NEAR(log::derivative_info(0.05, {log::FilterWindow::causal, 0.5, 2}).noise_gain, 7.089,
              1e-3);
}

TEST(Derivative, IsCausalWhereItSaysSo) {
  log::Signal signal = sampled([](double t) { return std::sin(t); }, 100);
  const Values before =
      log::derivative(signal, Values{2.5}, {log::FilterWindow::causal, 0.5, 2}, 1.0);
  for (std::size_t k = 51; k < 100; ++k) {
    signal.values[k] += 100.0;
  }
  EXPECT_EQ(log::derivative(signal, Values{2.5}, {log::FilterWindow::causal, 0.5, 2}, 1.0), before);
  EXPECT_NE(log::derivative(signal, Values{2.5}, {log::FilterWindow::centred, 0.5, 2}, 1.0),
            before);
}

TEST(Derivative, NoWindowReachesOverAnEndOrASilence) {
  log::Signal signal = sampled([](double t) { return t; }, 200);
  signal.times_s.erase(signal.times_s.begin() + 80, signal.times_s.begin() + 120);  // 4 to 6 s
  signal.values.erase(signal.values.begin() + 80, signal.values.begin() + 120);
  const Values at{0.1, 0.3, 3.6, 3.9, 5.0, 6.1, 6.3, 9.9};
  const Values centred = log::derivative(signal, at, {log::FilterWindow::centred, 0.5, 2}, 1.0);
  const Values causal = log::derivative(signal, at, {log::FilterWindow::causal, 0.5, 2}, 1.0);
  const std::vector<bool> has_centred{false, true, true, false, false, false, true, false};
  const std::vector<bool> has_causal{false, false, true, true, false, false, false, true};
  for (std::size_t k = 0; k < at.size(); ++k) {
    EXPECT_EQ(std::isfinite(centred[k]), has_centred[k]) << at[k];
    EXPECT_EQ(std::isfinite(causal[k]), has_causal[k]) << at[k];
  }
}

TEST(Derivative, SettingsThatCannotBeAreRefused) {
  const auto refusal = [](const log::DerivativeSettings& settings) {
    return testing::message_of<InputError>([&] { settings.validate(); });
  };
  EXPECT_EQ(refusal({}), "");
  EXPECT_NE(refusal({log::FilterWindow::centred, 0.0, 2}).find("window: 0 is out of range"),
            std::string::npos);
  EXPECT_NE(refusal({log::FilterWindow::centred, 0.5, 5}).find("degree: 5"), std::string::npos);
  EXPECT_NE(testing::message_of<InputError>([] {
              log::derivative_info(0.5, {log::FilterWindow::centred, 0.5, 2});
            }).find("a signal with 2 Hz; a polynomial of degree 2 takes 3 or more"),
            std::string::npos);
}

}  // namespace
}  // namespace kelpie::derivative_test
