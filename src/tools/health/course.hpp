// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kelpie::health {

/// An estimate with its standard error.
struct Estimate {
  double value = 0.0;
  double error = 0.0;
};

/// A quantity from episode to episode, in the order of time.
struct Series {
  std::vector<double> days{};         ///< of each episode, never decreasing
  std::vector<Estimate> estimates{};  ///< errors > 0
};

/// Shape of a quantity over time.
enum class CourseKind : std::uint8_t {
  unknown,    ///< too few episodes for a test
  constant,   ///< no change is significant
  drift,      ///< constant, then a line
  step,       ///< one level, then another
  undecided,  ///< a change, whether drift or step is not told
};

/// The course of a quantity: whether, since when and how fast the quantity changed.
struct Course {
  CourseKind kind = CourseKind::unknown;
  Estimate before{};  ///< level before the change; of a constant, the mean
  /// The last level less the level before; of a constant, of the line through all episodes, as the
  /// bound for changes that were not found.
  Estimate change{};
  Estimate rate{};         ///< of a drift, per day
  double since_day = 0.0;  ///< a drift: last episode before the line; a step: first one after
  double since_low = 0.0;  ///< 90 % region of since_day
  double since_high = 0.0;
  double nats = 0.0;     ///< evidence for a change against a constant, penalties taken off
  double margin = 0.0;   ///< evidence for a drift against a step
  double scatter = 1.0;  ///< of values around the course, over the told errors
};

/// Compares a constant with a line and with a step that begin at any episode, by log likelihood
/// with BIC's penalties. The told errors count as known from kTuning.prior_episodes values, so that
/// episodes that scatter more weaken all evidence; correlated residuals of neighbouring episodes
/// weaken the evidence likewise. Sizes are means over the possible beginnings, weighted by
/// likelihood, and the beginnings' scatter is part of the errors. kTuning.least_nats bounds the
/// false reports of a year of weekly tests (docs/measured/applications.md). Requires as many days
/// as estimates. Cost: quadratic in the episodes.
Course judge(const Series& series);

/// The series from `day` on.
Series since(const Series& series, double day);

}  // namespace kelpie::health
