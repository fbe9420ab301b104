// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "live/configuration.hpp"
#include "live/pace.hpp"
#include "live/transport.hpp"
#include "log/read_log.hpp"

namespace kelpie::live {

/// Replay speed: a factor > 0, or infinite for "max". Throws InputError (--speed) on other texts.
double parse_speed(const std::string& text);

/// Replays a recording: messages in stored order, at the times of their reception.
class Replay final : public Transport {
 public:
  /// Replays the rows of the configuration where there are some, else the recording, which is read
  /// once for the checks of a log and for its reach; memory for the columns in use. Throws
  /// InputError as log::read_log() does, and on a path without a bag.
  Replay(const log::LogSource& source, const Configuration& configuration, double speed);

  const std::vector<bag::Topic>& topics() const override { return bag_->topics(); }
  Got next(bag::Message& message, std::chrono::milliseconds timeout) override;
  std::optional<log::Reach> reach() const override { return reach_; }
  std::vector<std::string> check() override { return {"a recording: " + bag_->source()}; }

  /// Delivers messages received up to `receive_ns` without pauses.
  void hurry_until(std::int64_t receive_ns) { hurry_until_ns_ = receive_ns; }

 private:
  bool is_due(std::chrono::milliseconds timeout) const;

  std::unique_ptr<bag::MessageReader> bag_;
  log::Reach reach_;
  Pace pace_;
  Pace::Clock::time_point due_;  // of waiting_
  bag::Message waiting_;
  bool has_waiting_ = false;
  std::int64_t hurry_until_ns_ = 0;
};

}  // namespace kelpie::live
