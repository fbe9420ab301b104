// SPDX-License-Identifier: Apache-2.0
#include "svr/function_mix.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/eigen.hpp"
#include "core/vector.hpp"

namespace kelpie {
namespace {

constexpr double kLeastShares = 1e-300;  // of a sum that is divided by

/// Sums over the functions of a mix; of all but the last from the first one's value.
struct MixSums {
  double mean = 0.0;     ///< Σ s_k f_k of all functions
  double first = 0.0;    ///< f_0
  double shares = 0.0;   ///< Σ s_k
  double apart = 0.0;    ///< Σ s_k (f_k − f_0)
  double squares = 0.0;  ///< Σ s_k (f_k − f_0)²
  double last = 0.0;     ///< f_last

  void add(double share, double value, bool is_last) {
    mean += share * value;
    if (is_last) {
      last = value;
      return;
    }
    first = shares == 0.0 && apart == 0.0 ? value : first;
    shares += share;
    apart += share * (value - first);
    squares += share * (value - first) * (value - first);
  }
};

/// The shrinkage of a mean and its derivatives.
struct Shrinkage {
  double by = 0.0;           ///< subtracted from the mean
  double slope = 0.0;        ///< ∂by/∂g
  double slope_of_d2 = 0.0;  ///< ∂by/∂D²
  double centre = 0.0;       ///< mean of f_k − f_0 of all functions but the last
};

Shrinkage shrinkage_of(const MixSums& sums, double caution) {
  if (caution == 0.0 || sums.shares <= 0.0) {
    return {};
  }
  const double centre = sums.apart / sums.shares;
  const double spread = caution * std::max(sums.squares / sums.shares - centre * centre, 0.0);
  const double g = sums.shares * (sums.first + centre - sums.last);
  const double signal = g * g + 1.0;
  const double all = signal + spread;
  return {.by = g * spread / all,
          .slope = spread * (all - 2.0 * g * g) / (all * all),
          .slope_of_d2 = caution * g * signal / (all * all),
          .centre = centre};
}

// Slopes of terms beyond their ranges become 0.
void flatten_beyond(std::span<const ValueRange> ranges, std::span<const double> x,
                    std::span<double> gradient) {
  const std::size_t first = x.size() - ranges.size();
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    if (x[first + k] < ranges[k].low || x[first + k] > ranges[k].high) {
      gradient[first + k] = 0.0;
    }
  }
}

double value_of(const FunctionMix& mix, std::span<const double> x) {
  const auto [low, high, caution] = mix.limits;
  const ScaledSample moved = within_ranges(mix.term_ranges, x);
  MixSums sums;
  std::size_t left = mix.members.size();
  for (const auto& [name, share, function] : mix.members) {
    sums.add(share, std::clamp(function(as_span(moved)), low, high), --left == 0);
  }
  return sums.mean - shrinkage_of(sums, caution).by;
}

double value_and_gradient(const FunctionMix& mix, std::span<const double> x,
                          std::span<double> gradient) {
  const auto [low, high, caution] = mix.limits;
  const ScaledSample moved = within_ranges(mix.term_ranges, x);
  using Slopes = std::array<double, kMostInputs + kMostTerms>;
  Slopes slopes{};
  Slopes spread_slopes{};  // Σ s_k (f_k − f_0) ∇f_k of all functions but the last
  Slopes last_slopes{};
  const std::span<double> own = std::span(slopes).first(x.size());
  const std::span<double> by_spread = std::span(spread_slopes).first(x.size());
  const std::span<double> by_last = std::span(last_slopes).first(x.size());
  std::ranges::fill(gradient, 0.0);
  MixSums sums;
  std::size_t left = mix.members.size();
  double last_share = 0.0;
  for (const auto& [name, share, function] : mix.members) {
    const bool is_last = --left == 0;
    const double free = function.with_gradient(as_span(moved), own);
    const double value = std::clamp(free, low, high);
    sums.add(share, value, is_last);
    if (free <= low || free >= high) {
      continue;
    }
    if (is_last) {
      last_share = share;
      std::ranges::copy(own, by_last.begin());
    } else {
      add_scaled(share, std::span<const double>(own), gradient);
      add_scaled(share * (value - sums.first), std::span<const double>(own), by_spread);
    }
  }
  // g = Σ s_k f_k − shares f_last and D² = squares / shares − centre², both of all but the last
  const Shrinkage shrinkage = shrinkage_of(sums, caution);
  const double d2 = shrinkage.slope_of_d2 * 2.0 / std::max(sums.shares, kLeastShares);
  const double of_gradient = 1.0 - shrinkage.slope + d2 * shrinkage.centre;
  const double of_last = last_share + shrinkage.slope * sums.shares;
  for (std::size_t k = 0; k < x.size(); ++k) {
    gradient[k] = of_gradient * gradient[k] - d2 * by_spread[k] + of_last * by_last[k];
  }
  flatten_beyond(mix.term_ranges, x, gradient);
  return sums.mean - shrinkage.by;
}

}  // namespace

ScaledSample within_ranges(std::span<const ValueRange> ranges, std::span<const double> x) {
  ScaledSample moved(x.size());
  std::ranges::copy(x, moved.begin());
  const std::size_t first = x.size() - ranges.size();
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    moved[first + k] = std::clamp(moved[first + k], ranges[k].low, ranges[k].high);
  }
  return moved;
}

double FunctionMix::operator()(std::span<const double> x) const {
  return value_of(*this, x) + dot(std::span<const double>(nominal), x.last(nominal.size()));
}

double FunctionMix::with_gradient(std::span<const double> x, std::span<double> gradient) const {
  const double value = value_and_gradient(*this, x, gradient);
  add_scaled(1.0, std::span<const double>(nominal), gradient.last(nominal.size()));
  return value + dot(std::span<const double>(nominal), x.last(nominal.size()));
}

double FunctionMix::term_weight(std::size_t k) const {
  const auto posterior = std::ranges::find(members, "posterior", &Member::name);
  if (posterior != members.end()) {
    return nominal_weight(k) + posterior->function.term_weights()[k];
  }
  double sum = nominal_weight(k);
  for (const Member& member : members) {
    sum += member.share * member.function.term_weights()[k];
  }
  return sum;
}

}  // namespace kelpie
