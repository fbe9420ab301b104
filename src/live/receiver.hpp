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

#include "bag/topic_columns.hpp"
#include "kelpie/stream/sample_stream.hpp"
#include "live/configuration.hpp"
#include "live/health.hpp"

namespace kelpie::live {

/// Raw messages in, rows out: decodes them by their definition, as those of bags are, and shows
/// them to a SampleStream. What is wrong with a message is counted and does no other harm. Used by
/// one thread.
class Receiver {
 public:
  /// Times count from `origin_ns` on, by the clock of the configuration; without one from the
  /// earliest stamp among the first messages, which wait for that as long as the stream waits for
  /// late ones, or where the first one is of another clock. Where a clock is set, back or ahead by
  /// more than LearningClock::kLongestPause, times go on after a short silence and count from
  /// another origin: they never get so large that a double rounds them. Throws InputError where a
  /// message definition's folder is missing.
  Receiver(const Configuration& configuration, std::optional<std::int64_t> origin_ns);

  /// Shows a message of one of these topics. Call next() until it has no row. Throws nothing on
  /// what comes.
  void receive(const std::vector<bag::Topic>& topics, const bag::Message& message);

  /// The next row that is complete, or null; until the next call.
  const SampleRow* next() { return stream_.next(); }

  /// Nothing more comes, so next() gives the rows that wait.
  void finish();

  /// Whether a velocity of the row at `t` [s] is one whose value doesn't change any more.
  bool is_stuck(double t) const;

  /// The inputs as they are now, each taken `shift_s` seconds later (below 0: earlier) as far as is
  /// known. False where one of them is silent or no source of its own.
  bool newest(std::span<const double> shift_s, std::span<double> x) const;
  double now_s() const { return now_s_; }  ///< the newest stamp, since the origin

  /// Where times count from now; none: nothing has come.
  const std::optional<std::int64_t>& origin_ns() const { return origin_ns_; }
  /// The same for the row at `t`, which may have been made before a clock was set.
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

  void bind(const bag::Topic& topic);
  void add(const Held& sample);
  void find_origin();
  void feed(const Held& sample);
  void move_origin(double by_s);
  void resume_at(std::int64_t time_ns);
  double since_origin_s(std::int64_t time_ns) const;

  bag::MessageDefinitions definitions_;
  bag::Clock clock_;
  SampleStream stream_;
  std::vector<std::unique_ptr<bag::TopicColumns>> columns_;     // per topic in use
  std::vector<std::vector<std::vector<std::size_t>>> sources_;  // of each column of these
  std::vector<TopicHealth> health_;
  std::vector<std::size_t> by_topic_;  // the transport's number of a topic to ours
  std::vector<std::size_t> velocities_;
  std::vector<std::optional<std::size_t>> inputs_;  // their sources
  std::optional<std::int64_t> origin_ns_;
  std::int64_t before_ns_ = 0;  // the origin of times before moved_s_
  double moved_s_ = -std::numeric_limits<double>::infinity();
  std::vector<Held> held_;  // until there is an origin
  double now_s_ = 0.0;
  double newest_s_ = std::numeric_limits<double>::quiet_NaN();  // of all; none yet
};

}  // namespace kelpie::live
