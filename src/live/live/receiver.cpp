// SPDX-License-Identifier: Apache-2.0
#include "live/receiver.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/seconds.hpp"
#include "kelpie/core/error.hpp"
#include "live/checkpoint.hpp"
#include "live/tuning.hpp"
#include "log/ardusub.hpp"
#include "motion/states.hpp"
#include "stream/attitude_source.hpp"

namespace kelpie::live {
namespace {

constexpr std::size_t kNotInUse = static_cast<std::size_t>(-1);

std::optional<std::size_t> source_called(const StreamPlan& plan, const std::string& name) {
  const auto found = std::ranges::find(plan.sources, name, &StreamPlan::Source::name);
  return found == plan.sources.end()
             ? std::nullopt
             : std::optional(static_cast<std::size_t>(found - plan.sources.begin()));
}

// The signals that accelerations are derived from, poses too; without any, the inputs with a
// velocity's name.
std::vector<std::size_t> velocities_of(const StreamPlan& plan) {
  std::vector<std::size_t> velocities;
  for (const std::string& name : plan.pose ? plan.pose->sources() : std::vector<std::string>{}) {
    velocities.push_back(plan.source(name));
  }
  if (plan.pose) {
    return velocities;
  }
  velocities.reserve(plan.derived.size());
  for (const StreamPlan::Derived& derived : plan.derived) {
    velocities.push_back(plan.source(derived.of));
  }
  const std::size_t named = velocities.empty() ? named_velocities(plan.inputs) : 0;
  for (std::size_t i = 0; i < named; ++i) {
    if (const auto source = source_called(plan, plan.inputs[i])) {
      velocities.push_back(*source);
    }
  }
  return velocities;
}

// What is newer than the newest is held; with `holds` also what lies in a silence.
double value_at(const SignalHistory& signal, double t, Interpolation between, bool holds) {
  if (signal.size() == 0) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double value = signal.at(std::min(t, signal.newest_s()), between);
  if (!holds || std::isfinite(value)) {
    return value;
  }
  const std::size_t after = signal.first_after(t);
  return signal.value(after > 0 ? after - 1 : 0);
}

}  // namespace

Receiver::Receiver(const Configuration& configuration, std::optional<std::int64_t> origin_ns)
    : definitions_(configuration.log.messages),
      clock_(configuration.log.clock),
      armed_only_(configuration.log.armed_only),
      mirror_motors_(configuration.log.mirror_motors),
      stream_(configuration.plan),
      columns_(bag::columns_by_topic(configuration.columns())),
      velocities_(velocities_of(configuration.plan)),
      origin_ns_(origin_ns) {
  const StreamPlan& plan = configuration.plan;
  for (const auto& topic : columns_) {
    health_.push_back({.name = topic->topic()});
    sender_times_.expect(topic->topic());
    auto& of_topic = sources_.emplace_back();
    for (const bag::ColumnName& column : topic->columns()) {
      if (const auto least = configuration.live.valid.find(column.name);
          least != configuration.live.valid.end()) {
        validity_.push_back({health_.size() - 1, of_topic.size(), least->second});
      }
      auto& of_column = of_topic.emplace_back();
      for (std::size_t k = 0; k < plan.sources.size(); ++k) {
        if (plan.sources[k].from == column.name) {
          of_column.push_back(k);
        }
      }
    }
  }
  for (const StreamPlan::Source& source : plan.sources) {
    outputs_.push_back(mirror_motors_ ? log::output_of(source.from) : 0);
    factors_.emplace_back();
  }
  if (plan.pose && plan.pose->attitude.size() == 4) {
    for (const std::string& part : plan.pose->attitude) {
      quaternion_.push_back(plan.source(part));
    }
  }
  for (const std::string& input : plan.inputs) {
    inputs_.push_back(place_of(input));
  }
}

Receiver::InputPlace Receiver::place_of(const std::string& input) const {
  constexpr std::array<const char*, 3> kAngles{"phi", "theta", "psi"};
  InputPlace place{.source = source_called(stream_.plan(), input)};
  const auto* const angle = std::ranges::find(kAngles, input);
  if (!place.source && !quaternion_.empty() && angle != kAngles.end()) {
    place.angle = static_cast<std::size_t>(angle - kAngles.begin());
  }
  return place;
}

void Receiver::bind(const bag::Topic& topic) {
  const auto found = std::ranges::find(health_, topic.name, &TopicHealth::name);
  if (found == health_.end()) {
    by_topic_.push_back(kNotInUse);
    return;
  }
  const auto place = static_cast<std::size_t>(found - health_.begin());
  by_topic_.push_back(place);
  try {
    columns_[place]->bind(topic, definitions_, clock_);
    found->refused.clear();
  } catch (const InputError& error) {
    by_topic_.back() = kNotInUse;
    found->refused = error.what();
  }
}

void Receiver::receive(const std::vector<bag::Topic>& topics, const bag::Message& message) {
  while (by_topic_.size() < topics.size()) {
    bind(topics[by_topic_.size()]);
  }
  if (armed_only_ || mirror_motors_) {
    autopilot_.hear(topics, message);
  }
  const std::size_t place = by_topic_[message.topic];
  if (place == kNotInUse || (armed_only_ && autopilot_.is_disarmed())) {
    return;
  }
  bag::TopicColumns& columns = *columns_[place];
  ++health_[place].messages;
  try {
    columns.begin(message);
    columns.decoder().visit(message.data, columns);
  } catch (const InputError& error) {
    ++health_[place].undecodable;
    health_[place].last_error = error.what();
    return;
  }
  if (!columns.settle_time(sender_times_)) {
    return;
  }
  const bool is_valid = this->is_valid(place);
  for (std::size_t column = 0; column < sources_[place].size(); ++column) {
    for (const std::size_t source : sources_[place][column]) {
      const bool counts = is_valid || std::ranges::find(velocities_, source) == velocities_.end();
      double value = counts ? columns.values()[column] : std::numeric_limits<double>::quiet_NaN();
      if (mirror(source, health_[place], value)) {
        add({.source = source, .time_ns = columns.time_ns(), .value = value});
      }
    }
  }
}

// By the message's own word: NaN is no validity.
bool Receiver::is_valid(std::size_t topic) const {
  return std::ranges::all_of(validity_, [&](const Validity& one) {
    return one.topic != topic || columns_[topic]->values()[one.column] >= one.least;
  });
}

// Pulses wait for the parameters that tell their motor's direction: false until then.
bool Receiver::mirror(std::size_t source, TopicHealth& health, double& value) {
  const std::size_t output = outputs_[source];
  if (output == 0) {
    return true;
  }
  std::optional<double>& factor = factors_[source];
  if (!factor) {
    factor = log::pulse_factor(autopilot_.parameters(), output);
    if (!factor) {
      health.refused = "waits for the vehicle's parameter " +
                       log::next_parameter(autopilot_.parameters(), output) + " (mirror_motors)";
      return false;
    }
    health.refused.clear();
  }
  value = log::mirrored(value, *factor);
  return true;
}

void Receiver::add(const Held& sample) {
  if (origin_ns_) {
    feed(sample);
    return;
  }
  held_.push_back(sample);
  const auto [first, last] = std::ranges::minmax_element(held_, {}, &Held::time_ns);
  const bool has_waited = seconds(last->time_ns - first->time_ns) > stream_.plan().wait_s;
  if (has_waited || held_.size() == kTuning.most_held) {
    find_origin();
  }
}

void Receiver::find_origin() {
  if (held_.empty()) {
    return;
  }
  origin_ns_ = std::ranges::min_element(held_, {}, &Held::time_ns)->time_ns;
  std::ranges::for_each(held_, [&](const Held& sample) { feed(sample); });
  held_.clear();
  held_.shrink_to_fit();
}

double Receiver::since_origin_s(std::int64_t time_ns) const {
  return seconds(time_ns - origin_ns_.value_or(0));
}

void Receiver::feed(const Held& sample) {
  const double stamp_s = since_origin_s(sample.time_ns);
  if (std::isnan(newest_s_) && std::abs(stamp_s) > LearningClock::kLongestPause) {
    move_origin(std::floor(stamp_s));  // what a checkpoint has is of another clock
  } else if (stream_.begins_anew_with(stamp_s)) {
    stream_.begin_anew();
    resume_at(sample.time_ns);
  } else if (stamp_s > newest_s_ + LearningClock::kLongestPause) {
    resume_at(sample.time_ns);
  }
  now_s_ = since_origin_s(sample.time_ns);
  newest_s_ = std::fmax(newest_s_, now_s_);
  stream_.feed(sample.source, now_s_, sample.value);
}

// By whole seconds, so that rows stay at the same parts of one.
void Receiver::move_origin(double by_s) {
  origin_ns_ = origin_ns_.value_or(0) + static_cast<std::int64_t>(by_s) * kSecondNs;
}

void Receiver::resume_at(std::int64_t time_ns) {
  const StreamPlan& plan = stream_.plan();
  const double silence_s = 2.0 * (plan.gap_s + plan.wait_s + 1.0 / plan.rate_hz);
  const double by_s = std::floor(since_origin_s(time_ns) - newest_s_ - silence_s);
  before_ns_ = origin_ns_.value_or(0);
  moved_s_ = newest_s_ + silence_s / 2.0;
  move_origin(by_s);
}

void Receiver::finish() {
  if (!origin_ns_) {
    find_origin();
  }
  stream_.finish();
}

bool Receiver::is_stuck(double t) const {
  const auto is_stuck = [&](std::size_t source) { return stream_.is_stuck(source, t); };
  return stream_.plan().pose ? std::ranges::all_of(velocities_, is_stuck)
                             : std::ranges::any_of(velocities_, is_stuck);
}

double Receiver::silent_s(std::size_t source) const {
  const double newest_s = stream_.signal(source).newest_stamp_s();
  return std::isfinite(newest_s) ? newest_s_ - newest_s : std::numeric_limits<double>::infinity();
}

const SignalHistory* Receiver::input_signal(std::size_t input) const {
  return inputs_[input].source ? &stream_.signal(*inputs_[input].source) : nullptr;
}

double Receiver::angle_at(double t, std::size_t angle, bool holds) const {
  std::array<double, 4> quaternion{};
  for (std::size_t part = 0; part < quaternion.size(); ++part) {
    quaternion[part] = value_at(stream_.signal(quaternion_[part]), t, Interpolation::hold, holds);
  }
  return roll_pitch_yaw(quaternion)[angle];
}

bool Receiver::read_inputs(double t, std::span<const double> shift_s, std::span<double> x,
                           std::span<const std::size_t> silent, bool holds) const {
  const StreamPlan& plan = stream_.plan();
  const auto is_silent = [&](std::size_t source) {
    return !holds && !(now_s_ - stream_.signal(source).newest_s() <= plan.gap_s);
  };
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::ranges::find(silent, i) != silent.end()) {
      x[i] = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    const auto& [source, angle] = inputs_[i];
    if (angle && !std::ranges::any_of(quaternion_, is_silent)) {
      x[i] = angle_at(t, *angle, holds);
    } else if (!angle && source && !is_silent(*source)) {
      x[i] =
          value_at(stream_.signal(*source), t + shift_s[i], plan.sources[*source].between, holds);
    } else {
      return false;
    }
    if (!std::isfinite(x[i])) {
      return false;
    }
  }
  return true;
}

}  // namespace kelpie::live
