// SPDX-License-Identifier: Apache-2.0
#include "log/derivative.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

#include "kelpie/core/error.hpp"
#include "kelpie/core/quantile.hpp"
#include "kelpie/core/setting.hpp"

namespace kelpie::log {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int kHighestDegree = 4;
constexpr double kRounding = 1e-9;  // stamps are of nanoseconds

void require(bool holds, const std::string& field, double value, const std::string& allowed) {
  if (!holds) {
    throw InputError(field, number_text(value) + " is out of range; it has to be " + allowed);
  }
}

// The window around a time: how far it reaches back and ahead.
struct Reach {
  double back_s;
  double ahead_s;
};

Reach reach_of(const DerivativeSettings& settings) {
  return settings.window == FilterWindow::centred
             ? Reach{settings.window_s / 2.0, settings.window_s / 2.0}
             : Reach{settings.window_s, 0.0};
}

// The derivative at one time after the other.
class SlidingFit {
 public:
  SlidingFit(const Signal& signal, const DerivativeSettings& settings, double gap_s)
      : signal_(signal),
        reach_(reach_of(settings)),
        degree_(settings.degree),
        gap_s_(gap_s),
        step_s_(median_step_s(signal)) {}

  double at(double t) {
    const std::vector<double>& times = signal_.times_s;
    const auto first = std::ranges::lower_bound(times, t - reach_.back_s - kRounding);
    const auto last = std::ranges::upper_bound(times, t + reach_.ahead_s + kRounding);
    const auto too_long = [&](double a, double b) { return b - a > gap_s_; };
    if (last - first <= degree_ || std::adjacent_find(first, last, too_long) != last ||
        !reaches_back(first, t - reach_.back_s) || !reaches_ahead(last, t + reach_.ahead_s)) {
      return kNone;
    }
    offsets_s_.clear();
    std::transform(first, last, std::back_inserter(offsets_s_), [&](double s) { return s - t; });
    const std::vector<double> weights = derivative_weights(offsets_s_, degree_);
    const auto value = signal_.values.begin() + (first - times.begin());
    double slope = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      slope += weights[i] * value[static_cast<std::ptrdiff_t>(i)];
    }
    return slope;
  }

 private:
  using Stamp = std::vector<double>::const_iterator;

  // Beyond the window's edge the signal goes on, or the edge is as good as reached.
  bool reaches_back(Stamp first, double edge) const {
    const bool goes_on = first != signal_.times_s.begin() && *first - *(first - 1) <= gap_s_;
    return goes_on || *first <= edge + step_s_ + kRounding;
  }
  // A causal window must not ask for what comes next: a sample missed is all it may be behind.
  bool reaches_ahead(Stamp last, double edge) const {
    const bool goes_on =
        reach_.ahead_s > 0.0 && last != signal_.times_s.end() && *last - *(last - 1) <= gap_s_;
    const double behind = reach_.ahead_s > 0.0 ? step_s_ : 2.0 * step_s_;
    return goes_on || *(last - 1) >= edge - behind - kRounding;
  }

  const Signal& signal_;
  Reach reach_;
  int degree_;
  double gap_s_;
  double step_s_;
  std::vector<double> offsets_s_;
};

}  // namespace

void DerivativeSettings::validate() const {
  require(std::isfinite(window_s) && window_s > 0.0, "window", window_s, "> 0 s");
  require(degree >= 1 && degree <= kHighestDegree, "degree", degree, "1 to 4");
}

std::vector<double> derivative_weights(std::span<const double> offsets_s, int degree) {
  // In units of the window the powers stay near 1.
  double scale = 0.0;
  for (const double offset : offsets_s) {
    scale = std::max(scale, std::abs(offset));
  }
  const auto points = static_cast<Eigen::Index>(offsets_s.size());
  Eigen::MatrixXd powers(degree + 1, points);
  powers.row(0).setOnes();
  for (Eigen::Index i = 0; i < points; ++i) {
    for (Eigen::Index k = 1; k <= degree; ++k) {
      powers(k, i) = powers(k - 1, i) * offsets_s[static_cast<std::size_t>(i)] / scale;
    }
  }
  // The shortest w that takes 1, t, t² … to their slopes is that of least squares.
  const Eigen::VectorXd weights =
      powers.completeOrthogonalDecomposition().solve(Eigen::VectorXd::Unit(degree + 1, 1) / scale);
  return {weights.begin(), weights.end()};
}

DerivativeInfo derivative_info(std::span<const double> offsets_s, std::span<const double> weights) {
  DerivativeInfo info{.points = weights.size()};
  double squares = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    info.delay_s -= 0.5 * weights[i] * offsets_s[i] * offsets_s[i];
    squares += weights[i] * weights[i];
  }
  info.delay_s = std::abs(info.delay_s) < kRounding ? 0.0 : info.delay_s;
  info.noise_gain = std::sqrt(squares);
  return info;
}

DerivativeInfo derivative_info(double period_s, const DerivativeSettings& settings) {
  const Reach reach = reach_of(settings);
  const auto steps = [&](double seconds) {
    return static_cast<std::int64_t>(std::floor(seconds / period_s + kRounding));
  };
  std::vector<double> offsets;
  for (std::int64_t k = -steps(reach.back_s); k <= steps(reach.ahead_s); ++k) {
    offsets.push_back(static_cast<double>(k) * period_s);
  }
  if (offsets.size() <= static_cast<std::size_t>(settings.degree)) {
    throw InputError("window", number_text(settings.window_s) + " s hold " +
                                   std::to_string(offsets.size()) + " samples of a signal with " +
                                   number_text(1.0 / period_s) + " Hz; a polynomial of degree " +
                                   std::to_string(settings.degree) + " takes " +
                                   std::to_string(settings.degree + 1) + " or more");
  }
  return derivative_info(offsets, derivative_weights(offsets, settings.degree));
}

std::vector<double> derivative(const Signal& signal, std::span<const double> at_s,
                               const DerivativeSettings& settings, double gap_s) {
  SlidingFit fit(signal, settings, gap_s);
  std::vector<double> slopes;
  slopes.reserve(at_s.size());
  std::ranges::transform(at_s, std::back_inserter(slopes), [&](double t) { return fit.at(t); });
  return slopes;
}

double median_step_s(const Signal& signal) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < signal.times_s.size(); ++k) {
    steps.push_back(signal.times_s[k] - signal.times_s[k - 1]);
  }
  return steps.empty() ? 0.0 : quantile(steps, 0.5);
}

}  // namespace kelpie::log
