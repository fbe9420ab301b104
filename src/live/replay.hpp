// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "live/configuration.hpp"
#include "live/transport.hpp"
#include "log/read_log.hpp"

namespace kelpie::live {

/// How many times as quick as it was recorded; infinite: as quick as it can be taken.
/// Throws InputError (--speed) on what is neither a number > 0 nor "max".
double parse_speed(const std::string& text);

/// A recording in place of the vehicle: its messages in the order in which they are stored, at the
/// times at which they were received.
class Replay final : public Transport {
 public:
  /// Reads the whole recording once, for what a log is checked for and for its reach; memory for
  /// the columns in use. Throws InputError as log::read_log() does of topics and fields, and on a
  /// path that is no bag.
  Replay(const log::LogSource& source, const Configuration& configuration, double speed);

  const std::vector<bag::Topic>& topics() const override { return bag_->topics(); }
  Got next(bag::Message& message, std::chrono::milliseconds most) override;
  std::optional<log::Reach> reach() const override { return reach_; }
  std::vector<std::string> check() override { return {"a recording: " + bag_->source()}; }

  /// Messages received up to then come at once.
  void hurry_until(std::int64_t receive_ns) { hurry_until_ns_ = receive_ns; }

 private:
  using Clock = std::chrono::steady_clock;

  bool is_due(std::chrono::milliseconds most);

  std::unique_ptr<bag::BagReader> bag_;
  log::Reach reach_;
  double speed_;
  bag::Message waiting_;
  bool has_waiting_ = false;
  std::int64_t hurry_until_ns_ = 0;
  std::int64_t begin_ns_ = -1;  // of the paced part
  Clock::time_point began_;
};

}  // namespace kelpie::live
