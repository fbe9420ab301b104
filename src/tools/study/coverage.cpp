// SPDX-License-Identifier: Apache-2.0
#include "study/coverage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/quantile.hpp"
#include "study/metrics.hpp"
#include "study/tuning.hpp"

namespace kelpie::study {
namespace {

bool has_interval(const OneStep& steps, std::size_t i) {
  return std::isfinite(steps.upper[i] - steps.lower[i]);
}

bool holds(const OneStep& steps, std::size_t i) {
  return steps.lower[i] <= steps.truth[i] && steps.truth[i] <= steps.upper[i];
}

// How many steps in a row up to and including each have an interval and the same configuration.
std::vector<std::size_t> runs_of(const OneStep& steps) {
  std::vector<std::size_t> runs(steps.truth.size());
  std::size_t run = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const bool switched = i > 0 && steps.configuration[i] != steps.configuration[i - 1];
    run = has_interval(steps, i) ? (switched ? 1 : run + 1) : 0;
    runs[i] = run;
  }
  return runs;
}

constexpr std::size_t kBins = kTuning.intervals.novelty_bins;

struct Sum {
  double rows = 0.0;
  double square = 0.0;
  double held = 0.0;
};

}  // namespace

double one_step_r2(const OneStep& steps, std::span<const std::size_t> samples) {
  std::vector<double> truth;
  std::vector<double> predicted;
  std::size_t i = 0;
  for (const std::size_t sample : samples) {
    while (i < steps.samples.size() && steps.samples[i] < sample) {
      ++i;
    }
    if (i == steps.samples.size() || steps.samples[i] != sample) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    truth.push_back(steps.truth[i]);
    predicted.push_back(steps.predicted[i]);
  }
  return r_squared(truth, predicted);
}

std::vector<double> running_coverage(const OneStep& steps) {
  std::vector<double> shares(steps.truth.size(), std::numeric_limits<double>::quiet_NaN());
  const std::vector<std::size_t> runs = runs_of(steps);
  std::size_t held = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    held = runs[i] > 1 ? held : 0;
    held += holds(steps, i) ? 1 : 0;
    if (runs[i] > kCoverageWindow) {
      held -= holds(steps, i - kCoverageWindow) ? 1 : 0;
    }
    if (runs[i] >= kCoverageWindow) {
      shares[i] = static_cast<double>(held) / static_cast<double>(kCoverageWindow);
    }
  }
  return shares;
}

Coverage coverage_of(const OneStep& steps) {
  Coverage coverage;
  std::vector<double> widths;
  std::size_t held = 0;
  for (std::size_t i = 0; i < steps.truth.size(); ++i) {
    if (has_interval(steps, i)) {
      widths.push_back(steps.upper[i] - steps.lower[i]);
      held += holds(steps, i) ? 1 : 0;
    }
  }
  if (widths.empty()) {
    return coverage;
  }
  coverage.samples = widths.size();
  const auto count = static_cast<double>(widths.size());
  coverage.share = static_cast<double>(held) / count;
  coverage.mean_width = std::accumulate(widths.begin(), widths.end(), 0.0) / count;
  coverage.median_width = quantile(widths, 0.5);
  const std::vector<double> shares = running_coverage(steps);
  const std::vector<std::size_t> runs = runs_of(steps);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (runs[i] >= 2 * kCoverageWindow) {
      // fmin passes over the NaN of the start.
      coverage.lowest = std::fmin(coverage.lowest, shares[i]);
    }
  }
  return coverage;
}

std::vector<NoveltyBin> errors_by_novelty(std::span<const double> truth,
                                          std::span<const Prediction> predicted) {
  std::array<Sum, kBins> sums;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Prediction& one = predicted[i];
    if (std::isnan(one.novelty)) {
      continue;
    }
    const auto bin = static_cast<std::size_t>(one.novelty * static_cast<double>(kBins));
    Sum& sum = sums[std::min(bin, kBins - 1)];
    sum.rows += 1.0;
    sum.square += (truth[i] - one.value) * (truth[i] - one.value);
    sum.held += one.lower <= truth[i] && truth[i] <= one.upper ? 1.0 : 0.0;
  }
  if (std::ranges::all_of(sums, [](const Sum& sum) { return sum.rows == 0.0; })) {
    return {};
  }
  std::vector<NoveltyBin> bins;
  for (std::size_t i = 0; i < kBins; ++i) {
    const auto place = static_cast<double>(i);
    const Sum& sum = sums[i];
    bins.push_back({place / kBins, (place + 1.0) / kBins, static_cast<std::size_t>(sum.rows),
                    std::sqrt(sum.square / sum.rows), sum.held / sum.rows});
  }
  return bins;
}

}  // namespace kelpie::study
