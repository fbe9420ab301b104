// SPDX-License-Identifier: Apache-2.0
#include "kelpie/stream/sample_stream.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/angle.hpp"
#include "kelpie/core/error.hpp"
#include "stream/attitude_source.hpp"
#include "stream/derivative.hpp"
#include "stream/pose_window.hpp"
#include "stream/sample_queue.hpp"
#include "stream/tuning.hpp"

namespace kelpie {
namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();
constexpr double kAlways = std::numeric_limits<double>::infinity();
constexpr double kFarthestRow = 4503599627370496.0;  // 2^52: rows are counted in doubles
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

std::size_t most_kept(const StreamPlan& plan) {
  std::size_t most = 0;
  for (const StreamPlan::Source& source : plan.sources) {
    most = std::max(most, source.keep);
  }
  return most;
}

}  // namespace

class SampleStream::State {
 public:
  explicit State(const StreamPlan& plan);

  SignalVerdict feed(std::size_t source, double stamp_s, double value);
  const SampleRow* next();
  void finish();
  const StreamPlan& plan() const { return plan_; }
  const SignalHistory& signal(std::size_t source) const { return signals_[source]; }
  double silent_s(std::size_t source) const;
  bool is_stuck(std::size_t source, double t) const;
  std::size_t restarts() const { return restarts_; }
  bool begins_anew_with(double stamp_s) const;
  void begin_anew();

 private:
  // Destination of a source's samples: conversion of a vector changes signs and places.
  struct Route {
    std::size_t to = 0;
    double sign = 1.0;
  };
  enum class ColumnKind { sample, derived, mean, mean_angle, pose };
  struct Column {
    std::size_t source = 0;  // or the place among the pose's columns
    ColumnKind kind = ColumnKind::sample;
  };
  // Velocity samples wait until the rates at their time are known.
  struct Arm {
    std::array<std::size_t, 3> velocity{};
    std::array<std::size_t, 3> rates{};
    Triple arm_m{};
    std::vector<SampleQueue> waiting;  // of the three velocities; empty without an arm
  };

  // The three components of a world vector wait until the attitude at their time is known.
  struct Turn {
    std::array<std::size_t, 3> velocity{};
    AttitudeSource attitude;
    Frame from = Frame::ned;
    Frame to = Frame::frd;
    std::vector<SampleQueue> waiting{};  // of the three components
  };

  void route_vectors();
  void use_turns();
  void use_arm();
  void use_pose();
  Column column(const std::string& name) const;
  Column column_with_pose(const std::string& name) const;
  void follow_clock(double stamp_s);
  bool is_behind(double stamp_s) const;
  void reset();
  bool begin();
  SignalVerdict take(std::size_t source, double stamp_s, double value);
  SignalVerdict take_of_body(std::size_t source, double stamp_s, double value);
  void settle_turns();
  void drop_first(Turn& turn);
  void settle_arm();
  void settle_first(std::size_t part);
  double complete_until_s(std::size_t source) const;
  bool is_known(std::size_t source, double t, Interpolation between) const;
  bool is_known(double t) const;
  bool is_near_a_sample(double row) const;
  double next_sample_s(double t) const;
  double value(const Column& column, double t);
  void make_row(double t);

  StreamPlan plan_;
  std::vector<SignalHistory> signals_;
  std::vector<Route> routes_;
  Arm arm_;
  std::vector<Turn> turns_;
  std::vector<double> ahead_s_;          // extent of derivatives into the future, per source
  std::vector<double> back_s_;           // extent into the past
  std::vector<Interpolation> known_by_;  // a line for sources of derivatives
  std::vector<Column> columns_;          // inputs, then targets
  std::vector<double> values_;           // of a row
  Derivative derivative_;
  std::optional<PoseWindow> pose_;
  double clock_s_;  // newest stamp
  bool has_begun_ = false;
  double next_row_ = 0.0;  // as a multiple of 1 / rate
  SampleRow row_;
  std::size_t behind_ = 0;  // consecutive messages with old stamps
  std::size_t restarts_ = 0;
  bool is_finished_ = false;
};

SampleStream::State::State(const StreamPlan& plan)
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
    if (known_by_[source] == Interpolation::hold) {
      known_by_[source] = Interpolation::line;
    }
  }
  use_pose();
  for (const std::vector<std::string>* const names : {&plan_.inputs, &plan_.targets}) {
    std::ranges::for_each(*names, [&](const auto& name) { columns_.push_back(column(name)); });
  }
  values_.resize(columns_.size());
  route_vectors();
  use_turns();
  use_arm();
}

SampleStream::State::Column SampleStream::State::column(const std::string& name) const {
  if (plan_.pose) {
    return column_with_pose(name);
  }
  const auto derived = std::ranges::find(plan_.derived, name, &StreamPlan::Derived::name);
  return derived == plan_.derived.end()
             ? Column{.source = plan_.source(name)}
             : Column{.source = plan_.source(derived->of), .kind = ColumnKind::derived};
}

SampleStream::State::Column SampleStream::State::column_with_pose(const std::string& name) const {
  const std::vector<std::string> columns = plan_.pose->columns();
  const auto found = std::ranges::find(columns, name);
  if (found != columns.end()) {
    return {.source = static_cast<std::size_t>(found - columns.begin()), .kind = ColumnKind::pose};
  }
  const std::vector<std::string>& angles = plan_.pose->attitude;
  const bool is_angle = angles.size() == 3 && std::ranges::count(angles, name) > 0;
  return {.source = plan_.source(name),
          .kind = is_angle ? ColumnKind::mean_angle : ColumnKind::mean};
}

// Every source of a row with a pose is used over the whole window.
void SampleStream::State::use_pose() {
  if (!plan_.pose) {
    return;
  }
  require(plan_.pose->half_s > 0.0, "window",
          "has to be a number of s beside a pose; one to be found takes a log");
  pose_.emplace(plan_, most_kept(plan_));
  for (std::size_t k = 0; k < signals_.size(); ++k) {
    ahead_s_[k] = std::max(ahead_s_[k], plan_.pose->half_s);
    back_s_[k] = std::max(back_s_[k], plan_.pose->half_s);
  }
}

SignalVerdict SampleStream::State::feed(std::size_t source, double stamp_s, double value) {
  const Route& route = routes_[source];
  if (!(std::abs(stamp_s) * plan_.rate_hz <= kFarthestRow)) {  // NaN, too
    signals_[route.to].count_no_stamp();
    return SignalVerdict::no_stamp;
  }
  follow_clock(stamp_s);
  const StreamPlan::Source& from = plan_.sources[source];
  const double scaled = from.about + from.scale * (value - from.about);
  const SignalVerdict heard = take(route.to, stamp_s, route.sign * scaled);
  settle_turns();
  settle_arm();
  return heard;
}

void SampleStream::State::follow_clock(double stamp_s) {
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

bool SampleStream::State::is_behind(double stamp_s) const {
  return stamp_s < clock_s_ - plan_.gap_s - plan_.wait_s;
}

bool SampleStream::State::begins_anew_with(double stamp_s) const {
  return !is_finished_ && is_behind(stamp_s) &&
         behind_ + 1 >= stream::kTuning.messages_behind * signals_.size();
}

void SampleStream::State::begin_anew() {
  reset();
  ++restarts_;
}

void SampleStream::State::reset() {
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

void SampleStream::State::finish() {
  clock_s_ = kAlways;
  is_finished_ = true;
  settle_turns();
  settle_arm();
}

double SampleStream::State::silent_s(std::size_t source) const {
  const double newest = signals_[source].newest_stamp_s();
  return newest == kNever ? kAlways : clock_s_ - newest;
}

bool SampleStream::State::is_stuck(std::size_t source, double t) const {
  const double from_s = t - back_s_[source] - stream::kTuning.window_rounding_s;
  return signals_[source].was_stuck(from_s, t + ahead_s_[source]);
}

// All samples of a source that lie before this are there.
double SampleStream::State::complete_until_s(std::size_t source) const {
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
bool SampleStream::State::is_known(std::size_t source, double t, Interpolation between) const {
  const SignalHistory& signal = signals_[source];
  const double newest = signal.newest_s();
  const double next = between == Interpolation::hold ? t : std::max(t, newest + plan_.gap_s);
  const bool has_neighbours =
      between != Interpolation::curve || signal.first_after(t) + 1 < signal.size() || newest == t;
  return (newest >= t && has_neighbours) || complete_until_s(source) > next;
}

bool SampleStream::State::is_known(double t) const {
  for (std::size_t k = 0; k < signals_.size(); ++k) {
    if (!is_known(k, t + ahead_s_[k], known_by_[k])) {
      return false;
    }
  }
  return true;
}

bool SampleStream::State::begin() {
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

bool SampleStream::State::is_near_a_sample(double row) const {
  return std::ranges::any_of(signals_, [&](const SignalHistory& signal) {
    const std::size_t after = signal.first_after(row / plan_.rate_hz);
    return (after > 0 && row <= (signal.time_s(after - 1) + plan_.gap_s) * plan_.rate_hz) ||
           (after < signal.size() &&
            row >= std::ceil((signal.time_s(after) - plan_.gap_s) * plan_.rate_hz));
  });
}

// When the first sample after `t` is, or may come to be.
double SampleStream::State::next_sample_s(double t) const {
  double next = kAlways;
  for (std::size_t k = 0; k < signals_.size(); ++k) {
    const std::size_t after = signals_[k].first_after(t);
    next = std::min(next,
                    after < signals_[k].size() ? signals_[k].time_s(after) : complete_until_s(k));
  }
  return next;
}

const SampleRow* SampleStream::State::next() {
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

double SampleStream::State::value(const Column& column, double t) {
  if (column.kind == ColumnKind::pose) {
    return pose_->value(column.source);
  }
  const SignalHistory& signal = signals_[column.source];
  switch (column.kind) {
    case ColumnKind::derived:
      return derivative_.at(signal, t);
    case ColumnKind::mean:
      return pose_->mean(signal, plan_.sources[column.source].between);
    case ColumnKind::mean_angle:
      return pose_->mean_angle(signal);
    case ColumnKind::pose:
    case ColumnKind::sample:
      break;
  }
  return signal.at(t, plan_.sources[column.source].between);
}

void SampleStream::State::make_row(double t) {
  if (pose_) {
    pose_->move_to(signals_, t);
  }
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    values_[i] = value(columns_[i], t);
  }
  for (std::size_t k = 0; k < signals_.size(); ++k) {
    const std::size_t after = signals_[k].first_after(t);
    const bool has_used_it = known_by_[k] != Interpolation::hold && after < signals_[k].size();
    signals_[k].close(std::max(t + ahead_s_[k], has_used_it ? signals_[k].time_s(after) : t));
  }
  const std::span<const double> values = values_;
  row_ = {.t = t,
          .x = values.first(plan_.inputs.size()),
          .y = values.subspan(plan_.inputs.size()),
          .is_whole = std::ranges::all_of(values, [](double v) { return std::isfinite(v); })};
}

// Frames: signs, attitudes, lever arm.

// Converting a vector is the same for each of its samples, a sign and a place per component; so the
// components needn't wait for each other.
void SampleStream::State::route_vectors() {
  for (const StreamPlan::Vector& vector : plan_.vectors) {
    if (!vector.attitude.empty()) {
      continue;
    }
    const std::vector<Route> before = routes_;
    for (std::size_t from = 0; from < 3; ++from) {
      Triple unit{};
      unit[from] = 1.0;
      const Triple image = converted(unit, vector.from, vector.to);
      const std::size_t source = plan_.source(vector.columns[from]);
      const auto to = static_cast<std::size_t>(
          std::ranges::find_if(image, [](double part) { return part != 0.0; }) - image.begin());
      for (std::size_t k = 0; k < before.size(); ++k) {
        if (before[k].to == source) {
          routes_[k] = {.to = plan_.source(vector.columns[to]), .sign = before[k].sign * image[to]};
        }
      }
    }
  }
}

void SampleStream::State::use_arm() {
  if (!plan_.lever_arm) {
    return;
  }
  arm_.arm_m = plan_.lever_arm->arm_m;
  for (std::size_t part = 0; part < 3; ++part) {
    arm_.velocity[part] = plan_.source(plan_.lever_arm->velocity[part]);
    arm_.rates[part] = plan_.source(plan_.lever_arm->rates[part]);
    arm_.waiting.emplace_back(plan_.sources[arm_.velocity[part]].keep);
  }
}

void SampleStream::State::use_turns() {
  for (const StreamPlan::Vector& vector : plan_.vectors) {
    if (vector.attitude.empty()) {
      continue;
    }
    std::vector<std::size_t> attitude;
    for (const std::string& name : vector.attitude) {
      attitude.push_back(plan_.source(name));
    }
    const double unit = vector.is_in_degrees ? kRadPerDegree : 1.0;
    Turn& turn = turns_.emplace_back(
        Turn{.attitude = {std::move(attitude), unit, true}, .from = vector.from, .to = vector.to});
    for (std::size_t part = 0; part < 3; ++part) {
      turn.velocity[part] = plan_.source(vector.columns[part]);
      turn.waiting.emplace_back(plan_.sources[turn.velocity[part]].keep);
    }
  }
}

SignalVerdict SampleStream::State::take(std::size_t source, double stamp_s, double value) {
  for (Turn& turn : turns_) {
    const auto* const part = std::ranges::find(turn.velocity, source);
    if (part != turn.velocity.end()) {
      SampleQueue& queue = turn.waiting[static_cast<std::size_t>(part - turn.velocity.begin())];
      if (queue.is_full()) {
        drop_first(turn);
      }
      queue.push({.stamp_s = stamp_s, .value = value});
      return std::isfinite(value) ? SignalVerdict::used : SignalVerdict::no_value;
    }
  }
  return take_of_body(source, stamp_s, value);
}

SignalVerdict SampleStream::State::take_of_body(std::size_t source, double stamp_s, double value) {
  for (std::size_t part = 0; part < arm_.waiting.size(); ++part) {
    if (arm_.velocity[part] == source && std::isfinite(value)) {
      SampleQueue& queue = arm_.waiting[part];
      if (queue.is_full()) {
        settle_first(part);
      }
      queue.push({.stamp_s = stamp_s, .value = value});
      return SignalVerdict::used;
    }
  }
  return signals_[source].add(stamp_s, value);
}

void SampleStream::State::settle_arm() {
  const auto are_known = [&](double stamp_s) {
    return std::ranges::all_of(arm_.rates, [&](std::size_t rate) {
      return is_known(rate, stamp_s - signals_[rate].lag_s(), Interpolation::line);
    });
  };
  for (std::size_t part = 0; part < arm_.waiting.size(); ++part) {
    while (!arm_.waiting[part].is_empty() && are_known(arm_.waiting[part].front().stamp_s)) {
      settle_first(part);
    }
  }
}

void SampleStream::State::settle_first(std::size_t part) {
  const SampleQueue::Sample sample = arm_.waiting[part].pop();
  Triple rates{};
  for (std::size_t i = 0; i < 3; ++i) {
    const SignalHistory& rate = signals_[arm_.rates[i]];
    rates[i] = rate.at(sample.stamp_s - rate.lag_s(), Interpolation::line);
  }
  Triple velocity{};
  velocity[part] = sample.value;
  signals_[arm_.velocity[part]].add(sample.stamp_s,
                                    without_lever_arm(velocity, rates, arm_.arm_m)[part]);
}

// All three are of one message; where one is missing, the others are nothing.
void SampleStream::State::settle_turns() {
  for (Turn& turn : turns_) {
    while (std::ranges::none_of(turn.waiting, &SampleQueue::is_empty)) {
      const double stamp_s =
          std::max({turn.waiting[0].front().stamp_s, turn.waiting[1].front().stamp_s,
                    turn.waiting[2].front().stamp_s});
      const bool is_whole = std::ranges::all_of(
          turn.waiting, [&](const SampleQueue& one) { return one.front().stamp_s == stamp_s; });
      if (!is_whole) {
        drop_first(turn);
        continue;
      }
      const bool is_ready = std::ranges::all_of(turn.attitude.places(), [&](std::size_t source) {
        return is_known(source, stamp_s - signals_[source].lag_s(), Interpolation::line);
      });
      if (!is_ready) {
        break;
      }
      Triple vector{};
      for (std::size_t part = 0; part < 3; ++part) {
        vector[part] = turn.waiting[part].pop().value;
      }
      vector = turn.attitude.in_body(signals_, vector, stamp_s);
      vector = converted(vector, turn.from == Frame::ned ? Frame::frd : Frame::flu, turn.to);
      for (std::size_t part = 0; part < 3; ++part) {
        take_of_body(turn.velocity[part], stamp_s, vector[part]);
      }
    }
  }
}

void SampleStream::State::drop_first(Turn& turn) {
  double first_s = std::numeric_limits<double>::infinity();
  for (const SampleQueue& queue : turn.waiting) {
    first_s = queue.is_empty() ? first_s : std::min(first_s, queue.front().stamp_s);
  }
  for (std::size_t part = 0; part < 3; ++part) {
    if (!turn.waiting[part].is_empty() && turn.waiting[part].front().stamp_s == first_s) {
      turn.waiting[part].pop();
      signals_[turn.velocity[part]].add(first_s, kMissing);
    }
  }
}

SampleStream::SampleStream(const StreamPlan& plan) : state_(std::make_unique<State>(plan)) {}
SampleStream::SampleStream(SampleStream&&) noexcept = default;
SampleStream& SampleStream::operator=(SampleStream&&) noexcept = default;
SampleStream::~SampleStream() = default;

SignalVerdict SampleStream::feed(std::size_t source, double stamp_s, double value) {
  return state_->feed(source, stamp_s, value);
}

const SampleRow* SampleStream::next() {
  return state_->next();
}

void SampleStream::finish() {
  state_->finish();
}

const StreamPlan& SampleStream::plan() const {
  return state_->plan();
}

const SignalHistory& SampleStream::signal(std::size_t source) const {
  return state_->signal(source);
}

double SampleStream::silent_s(std::size_t source) const {
  return state_->silent_s(source);
}

bool SampleStream::is_stuck(std::size_t source, double t) const {
  return state_->is_stuck(source, t);
}

std::size_t SampleStream::restarts() const {
  return state_->restarts();
}

bool SampleStream::begins_anew_with(double stamp_s) const {
  return state_->begins_anew_with(stamp_s);
}

void SampleStream::begin_anew() {
  state_->begin_anew();
}

}  // namespace kelpie
