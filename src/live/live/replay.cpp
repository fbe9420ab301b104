// SPDX-License-Identifier: Apache-2.0
#include "live/replay.hpp"

#include <algorithm>
#include <limits>
#include <thread>

#include "bag/open_bag.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "live/row_reader.hpp"

namespace kelpie::live {
double parse_speed(const std::string& text) {
  double speed = 0.0;
  if (text == "max") {
    return std::numeric_limits<double>::infinity();
  }
  if (!parse_number(text, speed) || !(speed >= 0.001) || speed > 1e6) {
    throw InputError("--speed", "'" + text + "' has to be a number from 0.001 to 1e+06, or max");
  }
  return speed;
}

Replay::Replay(const log::LogSource& source, const Configuration& configuration, double speed)
    : pace_(speed) {
  if (configuration.rows) {
    bag_ = std::make_unique<RowReader>(configuration.rows, configuration.further);
    reach_ = RowReader::reach_of(*configuration.rows, configuration.further.get());
    return;
  }
  if (!bag::is_bag(source.path)) {
    throw InputError({.file = source.path, .line = 0, .field = "--replay"},
                     "is no recording of messages; it takes " + bag::recording_formats());
  }
  reach_ = log::read_reach(source, configuration.log);
  bag_ = source.open_bag(log::row_times(configuration.log, {}));
}

Transport::Got Replay::next(bag::Message& message, std::chrono::milliseconds timeout) {
  if (!has_waiting_) {
    if (!bag_->next(waiting_)) {
      return Got::end;
    }
    has_waiting_ = true;
    if (waiting_.receive_ns > hurry_until_ns_) {
      due_ = pace_.next(waiting_.receive_ns, Pace::Clock::now());
    }
  }
  if (!is_due(timeout)) {
    return Got::nothing;
  }
  message = waiting_;
  has_waiting_ = false;
  return Got::message;
}

bool Replay::is_due(std::chrono::milliseconds timeout) const {
  const auto left = due_ - Pace::Clock::now();
  if (left > Pace::Clock::duration::zero()) {
    std::this_thread::sleep_for(std::min<Pace::Clock::duration>(left, timeout));
  }
  return left <= timeout;
}

}  // namespace kelpie::live
