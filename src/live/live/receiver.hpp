// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bag/autopilot_state.hpp"
#include "bag/topic_columns.hpp"
#include "kelpie/stream/sample_stream.hpp"
#include "live/configuration.hpp"
#include "live/health.hpp"

namespace kelpie::live {

/// Turns raw messages into rows: decodes messages by their definitions, as in bags, and feeds a
/// SampleStream. Faulty messages are counted and left out. For one thread.
class Receiver {
 public:
  /// Times count from `origin_ns`, by the configuration's clock. Without an origin, or with one of
  /// another clock, times count from the earliest stamp of the first messages, held for as long as
  /// the stream waits for late samples. After a clock was set (back, or ahead by more than
  /// LearningClock::kLongestPause), times continue behind a short silence from a new origin, so
  /// that a double never rounds a time. Throws InputError on a missing folder of definitions.
  Receiver(const Configuration& configuration, std::optional<std::int64_t> origin_ns);

  /// Decodes a message of one of `topics`. Then call next() until null. Does not throw on data.
  void receive(const std::vector<bag::Topic>& topics, const bag::Message& message);

  /// The next complete row, valid until the next call; null: none.
  const SampleRow* next() { return stream_.next(); }

  /// Ends the input: next() gives the waiting rows.
  void finish();

  /// Whether a velocity, or every part of the pose, of the row at `t` [s] is stuck.
  bool is_stuck(double t) const;

  /// The inputs at `t` [s], at most now_s(), each from `shift_s` seconds later (below 0: earlier)
  /// as far as known. False where an input is silent, derived or a velocity from poses; inputs at
  /// the places `silent` may be, and are NaN.
  bool inputs_at(double t, std::span<const double> shift_s, std::span<double> x,
                 std::span<const std::size_t> silent = {}) const {
    return read_inputs(t, shift_s, x, silent, false);
  }
  /// The same, where silent inputs hold their last values. False where an input has none yet.
  bool held_inputs_at(double t, std::span<const double> shift_s, std::span<double> x,
                      std::span<const std::size_t> silent) const {
    return read_inputs(t, shift_s, x, silent, true);
  }
  /// The signal of an input; null of a derived input.
  const SignalHistory* input_signal(std::size_t input) const;
  double now_s() const { return now_s_; }  ///< the newest stamp, since the origin
  /// Since the signal's newest stamp, by the newest of all, after the end too; infinite: none yet.
  double silent_s(std::size_t source) const;

  /// Present origin of times; empty before the first message.
  const std::optional<std::int64_t>& origin_ns() const { return origin_ns_; }
  /// Origin of the row at `t`, which may precede a set clock.
  std::int64_t origin_ns(double t) const {
    return t < moved_s_ ? before_ns_ : origin_ns_.value_or(0);
  }
  const SampleStream& stream() const { return stream_; }
  const std::vector<TopicHealth>& topics() const { return health_; }

 private:
  struct Held {
    std::size_t source = 0;
    std::int64_t time_ns = 0;
    double value = 0.0;
  };

  // A message counts where the value of this column is `least` or above.
  struct Validity {
    std::size_t topic = 0;
    std::size_t column = 0;
    double least = 0.0;
  };

  // Where the present value of an input comes from.
  struct InputPlace {
    std::optional<std::size_t> source{};
    std::optional<std::size_t> angle{};  // of the pose's quaternion: 0 roll, 1 pitch, 2 yaw
  };

  void bind(const bag::Topic& topic);
  InputPlace place_of(const std::string& input) const;
  bool read_inputs(double t, std::span<const double> shift_s, std::span<double> x,
                   std::span<const std::size_t> silent, bool holds) const;
  double angle_at(double t, std::size_t angle, bool holds) const;
  bool is_valid(std::size_t topic) const;
  bool mirror(std::size_t source, TopicHealth& health, double& value);
  void add(const Held& sample);
  void find_origin();
  void feed(const Held& sample);
  void move_origin(double by_s);
  void resume_at(std::int64_t time_ns);
  double since_origin_s(std::int64_t time_ns) const;

  bag::MessageDefinitions definitions_;
  bag::Clock clock_;
  bool armed_only_;
  bool mirror_motors_;
  std::vector<std::size_t> outputs_;            // of each source; 0: no output of an autopilot
  std::vector<std::optional<double>> factors_;  // of each source's pulses, once told
  bag::AutopilotState autopilot_;
  SampleStream stream_;
  std::vector<std::unique_ptr<bag::TopicColumns>> columns_;     // per topic in use
  std::vector<std::vector<std::vector<std::size_t>>> sources_;  // fed by each column
  bag::SenderTimes sender_times_;
  std::vector<TopicHealth> health_;
  std::vector<Validity> validity_;     // of topics in use
  std::vector<std::size_t> by_topic_;  // index of a transport's topic -> index here
  std::vector<std::size_t> velocities_;
  std::vector<InputPlace> inputs_;
  std::vector<std::size_t> quaternion_;  // sources of the pose's; or empty
  std::optional<std::int64_t> origin_ns_;
  std::int64_t before_ns_ = 0;  // the origin of times before moved_s_
  double moved_s_ = -std::numeric_limits<double>::infinity();
  std::vector<Held> held_;  // until there is an origin
  double now_s_ = 0.0;
  double newest_s_ = std::numeric_limits<double>::quiet_NaN();  // over all signals; NaN: none yet
};

}  // namespace kelpie::live
