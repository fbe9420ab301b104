// SPDX-License-Identifier: Apache-2.0
#include "log/signal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "kelpie/core/error.hpp"

namespace kelpie::log {
namespace {

constexpr double kLongestSilenceS = 30.0 * 86400.0;  // within one log
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

[[noreturn]] void refuse(const Signal& signal, const std::string& message) {
  throw InputError(signal.from, message);
}

// Keeps the samples for which `keeps(k, kept)` holds, `kept` being the number of those before it.
template <typename Keeps>
std::size_t keep_if(Signal& signal, Keeps keeps) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < signal.values.size(); ++k) {
    if (keeps(k, kept)) {
      signal.times_s[kept] = signal.times_s[k];
      signal.values[kept++] = signal.values[k];
    }
  }
  const std::size_t left_out = signal.values.size() - kept;
  signal.times_s.resize(kept);
  signal.values.resize(kept);
  return left_out;
}

void find_gaps(const Signal& signal, double gap_s, SignalFaults& faults) {
  for (std::size_t k = 1; k < signal.values.size(); ++k) {
    const double silence = signal.times_s[k] - signal.times_s[k - 1];
    faults.gaps += silence > gap_s ? 1 : 0;
    if (silence > faults.longest_gap_s) {
      faults.longest_gap_s = silence;
      faults.longest_gap_at_s = signal.times_s[k - 1];
    }
  }
}

void find_stuck(const Signal& signal, double gap_s, SignalFaults& faults) {
  // Two equal values on both sides of a silence tell nothing.
  constexpr std::size_t kSamples = 5;
  for (std::size_t first = 0, k = 1; k <= signal.values.size(); ++k) {
    if (k < signal.values.size() && signal.values[k] == signal.values[first]) {
      continue;
    }
    const double lasted = signal.times_s[k - 1] - signal.times_s[first];
    if (k - first >= kSamples && lasted > gap_s) {
      ++faults.stuck;
      if (lasted > faults.longest_stuck_s) {
        faults.longest_stuck_s = lasted;
        faults.longest_stuck_at_s = signal.times_s[first];
      }
    }
    first = k;
  }
}

}  // namespace

void sort_by_time(Signal& signal) {
  for (std::size_t k = 1; k < signal.times_s.size(); ++k) {
    const double back = signal.times_s[k - 1] - signal.times_s[k];
    signal.steps_back += back > 0.0 ? 1 : 0;
    signal.longest_back_s = std::max(signal.longest_back_s, back);
  }
  if (signal.steps_back == 0) {
    return;
  }
  std::vector<std::size_t> order(signal.times_s.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return signal.times_s[k]; });
  const Signal as_stored = signal;
  for (std::size_t k = 0; k < order.size(); ++k) {
    signal.times_s[k] = as_stored.times_s[order[k]];
    signal.values[k] = as_stored.values[order[k]];
  }
}

SignalFaults tidy(Signal& signal, double gap_s) {
  if (signal.longest_back_s > gap_s) {
    refuse(signal, fmt::format("its time runs back by {:.3f} s; no clock that was set anew can be "
                               "followed",
                               signal.longest_back_s));
  }
  SignalFaults faults;
  faults.steps_back = signal.steps_back;
  faults.no_value =
      keep_if(signal, [&](std::size_t k, std::size_t) { return std::isfinite(signal.values[k]); });
  faults.duplicates = keep_if(signal, [&](std::size_t k, std::size_t kept) {
    return kept == 0 || signal.times_s[k] > signal.times_s[kept - 1];
  });
  faults.samples = signal.values.size();
  if (faults.samples == 0) {
    refuse(signal, "has no finite value in any message");
  }
  find_gaps(signal, gap_s, faults);
  if (faults.longest_gap_s > kLongestSilenceS) {
    const double from = faults.longest_gap_at_s;
    refuse(signal,
           fmt::format("its time jumps from {:.3f} to {:.3f} s: was a clock set meanwhile, or "
                       "are the stamps not in seconds?",
                       from, from + faults.longest_gap_s));
  }
  find_stuck(signal, gap_s, faults);
  return faults;
}

std::vector<double> resampled(const Signal& signal, std::span<const double> at_s, Between between,
                              double gap_s) {
  const std::vector<double>& times = signal.times_s;
  const std::vector<double>& values = signal.values;
  const auto value_at = [&](double t) {
    const auto after = std::ranges::upper_bound(times, t);
    if (after == times.begin()) {
      return kNone;
    }
    const auto k = static_cast<std::size_t>(std::distance(times.begin(), after)) - 1;
    if (between == Between::hold || times[k] == t) {
      return t - times[k] <= gap_s ? values[k] : kNone;
    }
    if (after == times.end() || times[k + 1] - times[k] > gap_s) {
      return kNone;
    }
    return std::lerp(values[k], values[k + 1], (t - times[k]) / (times[k + 1] - times[k]));
  };
  std::vector<double> taken;
  taken.reserve(at_s.size());
  std::ranges::transform(at_s, std::back_inserter(taken), value_at);
  return taken;
}

}  // namespace kelpie::log
