// SPDX-License-Identifier: Apache-2.0
#include "log/streamed_signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "kelpie/core/error.hpp"
#include "log/tuning.hpp"

namespace kelpie::log {
StreamedSignals::StreamedSignals(const StreamPlan& plan, const std::vector<Signal>& signals)
    : columns(plan.inputs.size()), stream_(plan), signals_(signals) {
  std::size_t samples = 0;
  for (const Signal& signal : signals) {
    samples += signal.values.size();
  }
  std::vector<std::size_t> shown(signals.size());
  for (std::size_t left = samples; left > 0; --left) {
    const std::size_t k = next_to_show(shown);
    stream_.feed(k, signals[k].times_s[shown[k]], signals[k].values[shown[k]]);
    ++shown[k];
    keep_rows(kTuning.most_rows_per_sample * samples);
  }
  stream_.finish();
  keep_rows(kTuning.most_rows_per_sample * samples);
  for (std::size_t k = 0; k < signals.size(); ++k) {
    require_sound(k);
  }
  end_with_the_first_to_end();
}

// The signal whose next sample has the earliest stamp.
std::size_t StreamedSignals::next_to_show(const std::vector<std::size_t>& shown) const {
  std::size_t next = 0;
  double earliest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < signals_.size(); ++k) {
    if (shown[k] < signals_[k].times_s.size() && signals_[k].times_s[shown[k]] < earliest) {
      next = k;
      earliest = signals_[k].times_s[shown[k]];
    }
  }
  return next;
}

void StreamedSignals::keep_rows(std::size_t most) {
  while (const SampleRow* const row = stream_.next()) {
    times_s.push_back(row->t);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      columns[i].push_back(row->x[i]);
    }
    if (times_s.size() > most) {
      throw InputError("rate",
                       fmt::format("{:.4g} rows per second are more than {} per sample of the log",
                                   stream_.plan().rate_hz, kTuning.most_rows_per_sample));
    }
    if (times_s.size() > kTuning.most_rows) {
      throw InputError("rate", fmt::format("{:.4g} rows per second give more than {} rows",
                                           stream_.plan().rate_hz, kTuning.most_rows));
    }
  }
}

void StreamedSignals::require_sound(std::size_t source) const {
  const SignalFaults& faults = signal(source).faults();
  const std::string& from = signals_[source].from;
  if (faults.no_stamp > 0) {
    throw InputError(from, fmt::format("its time reaches {:.4g} s, too far to count rows: are its "
                                       "stamps in seconds?",
                                       signals_[source].times_s.back()));
  }
  if (faults.samples == 0) {
    throw InputError(from, "has no finite value in any message");
  }
  if (faults.longest_gap_s > kTuning.longest_silence_s) {
    const double begin = faults.longest_gap_at_s;
    throw InputError(
        from, fmt::format("its time jumps from {:.3f} to {:.3f} s: was a clock set meanwhile, or "
                          "are the stamps not in seconds?",
                          begin, begin + faults.longest_gap_s));
  }
  // A line through samples that are all too far apart has a value nowhere.
  if (stream_.plan().sources[source].between != Interpolation::hold && faults.samples > 1 &&
      faults.gaps == faults.samples - 1) {
    throw InputError(
        from, fmt::format("its samples come every {:.4g} s, and silences longer than {:.4g} s "
                          "aren't bridged (`gap`); are its stamps in seconds?",
                          median_step_s(signals_[source]), stream_.plan().gap_s));
  }
}

// A stream can't know that a signal has ended, and goes on for a while.
void StreamedSignals::end_with_the_first_to_end() {
  std::size_t last_to_begin = 0;
  std::size_t first_to_end = 0;
  for (std::size_t k = 0; k < signals_.size(); ++k) {
    last_to_begin = signal(k).begin_s() > signal(last_to_begin).begin_s() ? k : last_to_begin;
    first_to_end = signal(k).newest_s() < signal(first_to_end).newest_s() ? k : first_to_end;
  }
  const double rate_hz = stream_.plan().rate_hz;
  const double end = signal(first_to_end).newest_s();
  const double begin = signal(last_to_begin).begin_s();
  const double last_row = std::floor(end * rate_hz + SampleStream::kRounding);
  if (last_row < std::ceil(begin * rate_hz - SampleStream::kRounding)) {
    throw InputError(
        signals_[first_to_end].from,
        fmt::format("ends at {:.3f} s, before {} begins at {:.3f} s (both since the log's "
                    "first message): no row has both; do their clocks agree?",
                    end, signals_[last_to_begin].from, begin));
  }
  const auto after = std::ranges::upper_bound(times_s, last_row / rate_hz);
  const auto rows = static_cast<std::size_t>(after - times_s.begin());
  times_s.resize(rows);
  std::ranges::for_each(columns, [&](auto& column) { column.resize(rows); });
}

}  // namespace kelpie::log
