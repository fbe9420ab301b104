// SPDX-License-Identifier: Apache-2.0
#include "stream/derivative.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "support.hpp"

namespace kelpie::derivative_test {
namespace {

using Values = std::vector<double>;

SignalHistory sampled(const std::function<double(double)>& f, std::size_t count,
                      double jitter_s = 0.0) {
  SignalHistory signal(count, 0.0, 1.0);
  RandomStream random(3, "stamps");
  for (std::size_t k = 0; k < count; ++k) {
    const double t = 0.05 * static_cast<double>(k) + jitter_s * random.uniform();
    signal.add(t, f(t));
  }
  return signal;
}

Values derivatives(const SignalHistory& signal, const Values& at,
                   const DerivativeSettings& settings) {
  Derivative derivative(settings, 1.0, signal.size());
  Values slopes;
  for (const double t : at) {
    slopes.push_back(derivative.at(signal, t));
  }
  return slopes;
}

Values middle_of(std::size_t count) {
  Values at;
  for (std::size_t k = count / 3; k < 2 * count / 3; ++k) {
    at.push_back(0.05 * static_cast<double>(k) + 0.013);
  }
  return at;
}

TEST(Derivative, IsExactForPolynomialsUpToItsDegreeWhateverTheStamps) {
  for (const FilterWindow window : {FilterWindow::centred, FilterWindow::causal}) {
    for (int degree = 1; degree <= 4; ++degree) {
      const auto f = [&](double t) { return 2.0 - 3.0 * t + std::pow(t, degree); };
      const auto slope = [&](double t) { return -3.0 + degree * std::pow(t, degree - 1); };
      const SignalHistory signal = sampled(f, 90, 0.02);
      const Values at = middle_of(90);
      const Values found = derivatives(signal, at, {window, 0.6, degree});
      for (std::size_t k = 0; k < at.size(); ++k) {
        EXPECT_NEAR(found[k], slope(at[k]), 1e-9 * std::pow(at[k], degree) + 1e-9) << degree;
      }
    }
  }
}

// Savitzky and Golay's tables: five points, quadratic, first derivative.
TEST(Derivative, HasTheClassicWeights) {
  SlopeWeights centred_weights(5);
  SlopeWeights end_weights(5);
  const auto centred = centred_weights.at(Values{-2, -1, 0, 1, 2}, 2);
  const auto end = end_weights.at(Values{-4, -3, -2, -1, 0}, 2);
  const Values classic{-0.2, -0.1, 0.0, 0.1, 0.2};
  const Values classic_end{26.0 / 70, -27.0 / 70, -40.0 / 70, -13.0 / 70, 54.0 / 70};
  for (std::size_t i = 0; i < classic.size(); ++i) {
    EXPECT_NEAR(centred[i], classic[i], 1e-12);
    EXPECT_NEAR(end[i], classic_end[i], 1e-12);
  }
}

TEST(Derivative, StatesTheDelayThatARampOfAccelerationShows) {
  const SignalHistory signal = sampled([](double t) { return 0.5 * t * t; }, 200);  // v' = t
  for (const DerivativeSettings& settings : {DerivativeSettings{FilterWindow::centred, 0.5, 1},
                                             DerivativeSettings{FilterWindow::centred, 0.5, 2},
                                             DerivativeSettings{FilterWindow::causal, 0.5, 1},
                                             DerivativeSettings{FilterWindow::causal, 0.5, 2}}) {
    const DerivativeInfo info = derivative_info(0.05, settings);
    const double found = derivatives(signal, Values{5.0}, settings).front();
    EXPECT_NEAR(5.0 - found, info.delay_s, 1e-9);
    const bool is_late = settings.window == FilterWindow::causal && settings.degree == 1;
    EXPECT_NEAR(info.delay_s, is_late ? 0.25 : 0.0, 1e-9);
    EXPECT_EQ(info.points, 11U);
  }
}

TEST(Derivative, StatesTheNoiseThatWhiteNoiseShows) {
  RandomStream random(11, "noise");
  const SignalHistory noise = sampled([&](double) { return random.normal(); }, 20'000);
  for (const FilterWindow window : {FilterWindow::centred, FilterWindow::causal}) {
    const DerivativeSettings settings{window, 0.5, 2};
    double squares = 0.0;
    Values at;
    for (std::size_t k = 20; k + 20 < noise.size(); ++k) {
      at.push_back(noise.time_s(k));
    }
    for (const double slope : derivatives(noise, at, settings)) {
      squares += slope * slope;
    }
    const double measured = std::sqrt(squares / static_cast<double>(at.size()));
    EXPECT_NEAR(measured / derivative_info(0.05, settings).noise_gain, 1.0, 0.05);
  }
  // As Savitzky and Golay have it for 11 points; looking back only costs.
  EXPECT_NEAR(derivative_info(0.05, {FilterWindow::centred, 0.5, 2}).noise_gain,
              std::sqrt(12.0 / (11.0 * 120.0)) / 0.05, 1e-9);
  EXPECT_NEAR(derivative_info(0.05, {FilterWindow::causal, 0.5, 2}).noise_gain, 7.089, 1e-3);
}

TEST(Derivative, IsCausalWhereItSaysSo) {
  const auto until_2_5 = [](double later) {
    return sampled([=](double t) { return std::sin(t) + (t > 2.5 ? later : 0.0); }, 100);
  };
  const SignalHistory signal = until_2_5(100.0);
  const Values before = derivatives(until_2_5(0.0), Values{2.5}, {FilterWindow::causal, 0.5, 2});
  EXPECT_EQ(derivatives(signal, Values{2.5}, {FilterWindow::causal, 0.5, 2}), before);
  EXPECT_NE(derivatives(signal, Values{2.5}, {FilterWindow::centred, 0.5, 2}), before);
}

TEST(Derivative, NoWindowReachesOverAnEndOrASilence) {
  // Nothing between 4 and 6 s.
  const SignalHistory signal =
      sampled([](double t) { return t < 3.99 || t > 5.99 ? t : std::nan(""); }, 200);
  const Values at{0.1, 0.3, 3.6, 3.9, 5.0, 6.1, 6.3, 9.9};
  const Values centred = derivatives(signal, at, {FilterWindow::centred, 0.5, 2});
  const Values causal = derivatives(signal, at, {FilterWindow::causal, 0.5, 2});
  const std::vector<bool> has_centred{false, true, true, false, false, false, true, false};
  const std::vector<bool> has_causal{false, false, true, true, false, false, false, true};
  for (std::size_t k = 0; k < at.size(); ++k) {
    EXPECT_EQ(std::isfinite(centred[k]), has_centred[k]) << at[k];
    EXPECT_EQ(std::isfinite(causal[k]), has_causal[k]) << at[k];
  }
}

TEST(Derivative, SettingsThatCannotBeAreRefused) {
  const auto refusal = [](const DerivativeSettings& settings) {
    return testing::message_of<InputError>([&] { settings.validate(); });
  };
  EXPECT_EQ(refusal({}), "");
  EXPECT_NE(refusal({FilterWindow::centred, 0.0, 2}).find("window: 0 is out of range"),
            std::string::npos);
  EXPECT_NE(refusal({FilterWindow::centred, 0.5, 5}).find("degree: 5"), std::string::npos);
  EXPECT_NE(testing::message_of<InputError>([] {
              derivative_info(0.5, {FilterWindow::centred, 0.5, 2});
            }).find("a signal with 2 Hz; a polynomial of degree 2 takes 3 or more"),
            std::string::npos);
}

}  // namespace
}  // namespace kelpie::derivative_test
