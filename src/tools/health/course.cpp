// SPDX-License-Identifier: Apache-2.0
#include "health/course.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "health/tuning.hpp"

namespace kelpie::health {
namespace {

using Numbers = std::vector<double>;

// y ≈ level + size x by least squares with given weights.
struct LineFit {
  Estimate level{};
  Estimate size{};  // error infinite where x is constant
  double chi2 = 0.0;
  double squares = 0.0;  // chi2 of the level alone
};

LineFit fit_line(const Series& series, const Numbers& x) {
  double w = 0.0, wx = 0.0, wy = 0.0, wxx = 0.0, wxy = 0.0, wyy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto [value, error] = series.estimates[i];
    const double weight = 1.0 / (error * error);
    w += weight;
    wx += weight * x[i];
    wy += weight * value;
  }
  const double mean_x = wx / w;
  const double mean_y = wy / w;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto [value, error] = series.estimates[i];
    const double weight = 1.0 / (error * error);
    wxx += weight * (x[i] - mean_x) * (x[i] - mean_x);
    wxy += weight * (x[i] - mean_x) * (value - mean_y);
    wyy += weight * (value - mean_y) * (value - mean_y);
  }
  LineFit fit{.squares = wyy};
  const double size = wxx > 0.0 ? wxy / wxx : 0.0;
  fit.size = {size, wxx > 0.0 ? std::sqrt(1.0 / wxx) : std::numeric_limits<double>::infinity()};
  fit.level = {mean_y - size * mean_x,
               std::sqrt(1.0 / w + (wxx > 0.0 ? mean_x * mean_x / wxx : 0.0))};
  fit.chi2 = std::max(0.0, wyy - size * wxy);
  return fit;
}

// The shapes of a change that begins at episode `at`: 0 before, 1 at the end.
Numbers shape(const Series& series, CourseKind kind, std::size_t at) {
  Numbers x(series.days.size());
  const double span = series.days.back() - series.days[at];
  for (std::size_t i = at; i < x.size(); ++i) {
    x[i] = kind == CourseKind::step ? 1.0 : (series.days[i] - series.days[at]) / span;
  }
  return x;
}

// A change of one kind, by its possible beginnings.
struct Candidate {
  CourseKind kind;
  std::vector<std::size_t> at{};
  std::vector<LineFit> fits{};
  Numbers nats{};  // of each beginning against a constant, without penalties
  std::size_t best = 0;
};

Candidate candidate(const Series& series, CourseKind kind) {
  Candidate found{.kind = kind};
  const std::size_t first = kind == CourseKind::step ? 1 : 0;
  for (std::size_t at = first; at + (kind == CourseKind::step ? 0 : 1) < series.days.size(); ++at) {
    if (kind == CourseKind::drift && !(series.days.back() > series.days[at])) {
      continue;
    }
    found.at.push_back(at);
    found.fits.push_back(fit_line(series, shape(series, kind, at)));
  }
  return found;
}

// Errors of neighbouring episodes that go together tell less than their number: the variance of a
// mean grows by (1 + ρ) / (1 − ρ).
double correlation_factor(const Series& series, const LineFit& fit, const Numbers& x) {
  Numbers residuals;
  double squares = 0.0, products = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto [value, error] = series.estimates[i];
    residuals.push_back((value - fit.level.value - fit.size.value * x[i]) / error);
    squares += residuals[i] * residuals[i];
    products += i > 0 ? residuals[i] * residuals[i - 1] : 0.0;
  }
  // The residuals' correlation is too low by some 2 / n for two fitted numbers; noise is no reason.
  const auto n = static_cast<double>(x.size());
  const double rho = products / std::max(squares, std::numeric_limits<double>::min()) + 2.0 / n;
  const double sure = rho - 1.0 / std::sqrt(n);
  const double used = std::clamp(sure > 0.0 ? rho : 0.0, 0.0, kTuning.most_correlation);
  return (1.0 + used) / (1.0 - used);
}

// −2 / (ν + n) times the log likelihood, with the scatter of the values integrated out.
double log_scatter(double chi2, double factor) {
  return std::log(kTuning.prior_episodes + chi2 / factor);
}

void weigh(Candidate& change, double n, double factor) {
  const double half = 0.5 * (kTuning.prior_episodes + n / factor);
  for (const LineFit& fit : change.fits) {
    change.nats.push_back(half *
                          (log_scatter(fit.squares, factor) - log_scatter(fit.chi2, factor)));
  }
  change.best =
      static_cast<std::size_t>(std::ranges::max_element(change.nats) - change.nats.begin());
}

std::size_t best_of(const Candidate& change) {
  return static_cast<std::size_t>(std::ranges::min_element(change.fits, {}, &LineFit::chi2) -
                                  change.fits.begin());
}

double penalty(const Candidate& change, double n) {
  return 0.5 * std::log(n) + std::log(static_cast<double>(change.at.size()));
}

// Mean over the beginnings; `of` gives an estimate for each.
template <typename Function>
Estimate averaged(const Candidate& change, double stretch, Function of) {
  double total = 0.0, mean = 0.0, square = 0.0;
  for (std::size_t k = 0; k < change.fits.size(); ++k) {
    const Estimate one = of(k);
    if (!std::isfinite(one.error)) {
      continue;
    }
    const double weight = std::exp(change.nats[k] - change.nats[change.best]);
    total += weight;
    mean += weight * one.value;
    square += weight * (one.value * one.value + stretch * one.error * one.error);
  }
  mean /= total;
  return {mean, std::sqrt(std::max(0.0, square / total - mean * mean))};
}

void describe(const Series& series, const Candidate& change, double stretch, Course& course) {
  const auto day = [&](std::size_t k) { return series.days[change.at[k]]; };
  course.before = averaged(change, stretch, [&](std::size_t k) { return change.fits[k].level; });
  course.change = averaged(change, stretch, [&](std::size_t k) { return change.fits[k].size; });
  if (change.kind == CourseKind::drift) {
    course.rate = averaged(change, stretch, [&](std::size_t k) {
      const double span = series.days.back() - day(k);
      return Estimate{change.fits[k].size.value / span, change.fits[k].size.error / span};
    });
  }
  for (Estimate* const size : {&course.change, &course.rate}) {
    size->error = std::hypot(size->error, kTuning.discrepancy * size->value);
  }
  course.since_day = course.since_low = course.since_high = day(change.best);
  for (std::size_t k = 0; k < change.at.size(); ++k) {
    if (change.nats[k] > change.nats[change.best] - kTuning.since_nats) {
      course.since_low = std::min(course.since_low, day(k));
      course.since_high = std::max(course.since_high, day(k));
    }
  }
}

// The variance of values over that of the told errors.
double stretch_of(double chi2, double n, double factor, double parameters) {
  const double freedom = kTuning.prior_episodes + n / factor - parameters;
  return factor * std::max(1.0, (kTuning.prior_episodes + chi2 / factor) / freedom);
}

}  // namespace

Course judge(const Series& series) {
  Course course;
  const std::size_t count = series.days.size();
  if (count < kTuning.fewest_episodes || !(series.days.back() > series.days.front())) {
    return course;
  }
  const auto n = static_cast<double>(count);
  Candidate drift = candidate(series, CourseKind::drift);
  Candidate step = candidate(series, CourseKind::step);
  const bool is_drift = drift.fits[best_of(drift)].chi2 <= step.fits[best_of(step)].chi2;
  const Candidate& nearer = is_drift ? drift : step;
  const std::size_t best = best_of(nearer);
  const double factor =
      correlation_factor(series, nearer.fits[best], shape(series, nearer.kind, nearer.at[best]));
  weigh(drift, n, factor);
  weigh(step, n, factor);
  const double drift_nats = drift.nats[drift.best] - penalty(drift, n);
  const double step_nats = step.nats[step.best] - penalty(step, n);
  const Candidate& change = drift_nats >= step_nats ? drift : step;
  course.nats = std::max(drift_nats, step_nats);
  course.margin = drift_nats - step_nats;
  const LineFit& whole = drift.fits.front();  // the line through all episodes
  if (course.nats < kTuning.least_nats) {
    course.kind = CourseKind::constant;
    const double stretch = stretch_of(whole.squares, n, factor, 1.0);
    const LineFit level = fit_line(series, Numbers(count, 0.0));
    course.before = {level.level.value, std::sqrt(stretch) * level.level.error};
    course.change = {whole.size.value, std::sqrt(stretch) * whole.size.error};
    course.scatter = std::sqrt(stretch);
    return course;
  }
  course.kind = std::abs(course.margin) < kTuning.kind_nats ? CourseKind::undecided : change.kind;
  const double stretch = stretch_of(change.fits[change.best].chi2, n, factor, 3.0);
  course.scatter = std::sqrt(stretch);
  describe(series, change, stretch, course);
  return course;
}

Series since(const Series& series, double day) {
  Series later;
  for (std::size_t i = 0; i < series.days.size(); ++i) {
    if (series.days[i] >= day) {
      later.days.push_back(series.days[i]);
      later.estimates.push_back(series.estimates[i]);
    }
  }
  return later;
}

}  // namespace kelpie::health
