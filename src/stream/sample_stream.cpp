// SPDX-License-Identifier: Apache-2.0
#include "kelpie/stream/sample_stream.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kelpie/core/error.hpp"

namespace kelpie {
namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();
constexpr double kAlways = std::numeric_limits<double>::infinity();
constexpr double kFarthestRow = 4503599627370496.0;  // 2^52: rows are counted in doubles
constexpr std::size_t kMessagesBehind = 8;           // per source

std::size_t most_kept(const StreamPlan& plan) {
  std::size_t most = 0;
  for (const StreamPlan::Source& source : plan.sources) {
    most = std::max(most, source.keep);
  }
  return most;
}

}  // namespace

SampleStream::SampleStream(const StreamPlan& plan)
    : plan_(plan), derivative_(plan.derivative, plan.gap_s, most_kept(plan)), clock_s_(kNever) {
  plan_.validate();
  require(!plan_.sources.empty(), "sources", "there have to be one or more");
  require(!plan_.inputs.empty(), "inputs", "there have to be one or more");
  for (std::size_t k = 0; k < plan_.sources.size(); ++k) {
    const StreamPlan::Source& source = plan_.sources[k];
    require(source.lag_s.has_value() && std::isfinite(*source.lag_s), source.name,
            "its lag has to be a number of s; one to be estimated takes a log");
    signals_.emplace_back(source.keep, *source.lag_s, plan_.gap_s);
    routes_.push_back({.to = k});
    ahead_s_.push_back(0.0);
    back_s_.push_back(0.0);
    known_by_.push_back(source.between);
  }
  for (const StreamPlan::Derived& derived : plan_.derived) {
    const std::size_t source = plan_.source(derived.of);
    ahead_s_[source] = plan_.derivative.ahead_s();
    back_s_[source] = plan_.derivative.back_s();
    known_by_[source] = Between::line;
  }
  for (const std::vector<std::string>* const names : {&plan_.inputs, &plan_.targets}) {
    std::ranges::for_each(*names, [&](const auto& name) { columns_.push_back(column(name)); });
  }
  values_.resize(columns_.size());
  route_vectors();
  use_turns();
  use_arm();
}

SampleStream::Column SampleStream::column(const std::string& name) const {
  const auto derived = std::ranges::find(plan_.derived, name, &StreamPlan::Derived::name);
  return derived == plan_.derived.end()
             ? Column{.source = plan_.source(name)}
             : Column{.source = plan_.source(derived->of), .is_derived = true};
}

Heard SampleStream::feed(std::size_t source, double stamp_s, double value) {
  const Route& route = routes_[source];
  if (!(std::abs(stamp_s) * plan_.rate_hz <= kFarthestRow)) {  // NaN, too
    signals_[route.to].count_no_stamp();
    return Heard::no_stamp;
  }
  follow_clock(stamp_s);
  const Heard heard = take(route.to, stamp_s, route.sign * value);
  settle_turns();
  settle_arm();
  return heard;
}

void SampleStream::follow_clock(double stamp_s) {
  if (is_finished_) {
    reset();
  }
  if (begins_anew_with(stamp_s)) {
    begin_anew();
  } else {
    behind_ = is_behind(stamp_s) ? behind_ + 1 : 0;
  }
  clock_s_ = std::max(clock_s_, stamp_s);
}

bool SampleStream::is_behind(double stamp_s) const {
  return stamp_s < clock_s_ - plan_.gap_s - plan_.wait_s;
}

bool SampleStream::begins_anew_with(double stamp_s) const {
  return !is_finished_ && is_behind(stamp_s) && behind_ + 1 >= kMessagesBehind * signals_.size();
}

void SampleStream::begin_anew() {
  reset();
  ++restarts_;
}

void SampleStream::reset() {
  std::ranges::for_each(signals_, &SignalHistory::reset);
  std::ranges::for_each(arm_.waiting, &SampleQueue::reset);
  for (Turn& turn : turns_) {
    std::ranges::for_each(turn.waiting, &SampleQueue::reset);
  }
  clock_s_ = kNever;
  has_begun_ = false;
  behind_ = 0;
  is_finished_ = false;
}

void SampleStream::finish() {
  clock_s_ = kAlways;
  is_finished_ = true;
  settle_turns();
  settle_arm();
}

double SampleStream::silent_s(std::size_t source) const {
  const double newest = signals_[source].newest_stamp_s();
  return newest == kNever ? kAlways : clock_s_ - newest;
}

bool SampleStream::is_stuck(std::size_t source, double t) const {
  const double from_s = t - back_s_[source] - Derivative::kRounding;
  return signals_[source].was_stuck(from_s, t + ahead_s_[source]);
}

// All samples of a source that lie before this are there.
double SampleStream::complete_until_s(std::size_t source) const {
  double stamp_s = clock_s_ - plan_.wait_s;
  const auto wait_for = [&](const auto& velocity, const std::vector<SampleQueue>& waiting) {
    for (std::size_t part = 0; part < waiting.size(); ++part) {
      if (velocity[part] == source && !waiting[part].is_empty()) {
        stamp_s = std::min(stamp_s, waiting[part].front().stamp_s);
      }
    }
  };
  wait_for(arm_.velocity, arm_.waiting);
  for (const Turn& turn : turns_) {
    wait_for(turn.velocity, turn.waiting);
  }
  return stamp_s - signals_[source].lag_s();
}

// Whether what a source has at `t` can't be changed any more by what comes in order.
bool SampleStream::is_known(std::size_t source, double t, Between between) const {
  const double newest = signals_[source].newest_s();
  const double next = between == Between::line ? std::max(t, newest + plan_.gap_s) : t;
  return newest >= t || complete_until_s(source) > next;
}

bool SampleStream::is_known(double t) const {
  for (std::size_t k = 0; k < signals_.size(); ++k) {
    if (!is_known(k, t + ahead_s_[k], known_by_[k])) {
      return false;
    }
  }
  return true;
}

bool SampleStream::begin() {
  double begin = kNever;
  for (const SignalHistory& signal : signals_) {
    begin = std::max(begin, signal.begin_s());
  }
  if (begin == kAlways) {
    return false;
  }
  next_row_ = std::ceil(begin * plan_.rate_hz - kRounding);
  has_begun_ = true;
  return true;
}

bool SampleStream::is_near_a_sample(double row) const {
  return std::ranges::any_of(signals_, [&](const SignalHistory& signal) {
    const std::size_t after = signal.first_after(row / plan_.rate_hz);
    return (after > 0 && row <= (signal.time_s(after - 1) + plan_.gap_s) * plan_.rate_hz) ||
           (after < signal.size() &&
            row >= std::ceil((signal.time_s(after) - plan_.gap_s) * plan_.rate_hz));
  });
}

// When the first sample after `t` is, or may come to be.
double SampleStream::next_sample_s(double t) const {
  double next = kAlways;
  for (std::size_t k = 0; k < signals_.size(); ++k) {
    const std::size_t after = signals_[k].first_after(t);
    next = std::min(next,
                    after < signals_[k].size() ? signals_[k].time_s(after) : complete_until_s(k));
  }
  return next;
}

const SampleRow* SampleStream::next() {
  if (!has_begun_ && !begin()) {
    return nullptr;
  }
  while (!is_near_a_sample(next_row_)) {
    const double next = next_sample_s(next_row_ / plan_.rate_hz);
    const double first = std::ceil((next - plan_.gap_s) * plan_.rate_hz);
    if (first <= next_row_ || next == kAlways) {
      return nullptr;
    }
    next_row_ = first;
  }
  const double t = next_row_ / plan_.rate_hz;
  if (!is_known(t)) {
    return nullptr;
  }
  next_row_ += 1.0;
  make_row(t);
  return &row_;
}

double SampleStream::value(const Column& column, double t) {
  const SignalHistory& signal = signals_[column.source];
  return column.is_derived ? derivative_.at(signal, t)
                           : signal.at(t, plan_.sources[column.source].between);
}

void SampleStream::make_row(double t) {
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    values_[i] = value(columns_[i], t);
  }
  for (std::size_t k = 0; k < signals_.size(); ++k) {
    const std::size_t after = signals_[k].first_after(t);
    const bool has_used_it = known_by_[k] == Between::line && after < signals_[k].size();
    signals_[k].close(std::max(t + ahead_s_[k], has_used_it ? signals_[k].time_s(after) : t));
  }
  const std::span<const double> values = values_;
  row_ = {.t = t,
          .x = values.first(plan_.inputs.size()),
          .y = values.subspan(plan_.inputs.size()),
          .is_whole = std::ranges::all_of(values, [](double v) { return std::isfinite(v); })};
}

}  // namespace kelpie
