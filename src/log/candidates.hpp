// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bag/inspect.hpp"
#include "log/known_roles.hpp"

namespace kelpie::log {

/// A signal of a log with a part that it may play.
struct CandidateColumn {
  std::string name;   ///< "/odom:twist.twist.linear.x", or a CSV column; "": there is none
  std::string topic;  ///< of the bag
  std::string unit{};
  double low = 0.0;
  double high = 0.0;
  double rate_hz = 0.0;
  std::optional<bag::ClockOffset> stamps{};  ///< none: its messages have no sender's time

  bool exists() const { return !name.empty(); }
  bool varies() const { return exists() && high > low; }
};

/// What may be a log's velocity, rates, attitude or commands.
struct Candidate {
  Part part = Part::velocity;
  std::string what;                      ///< "/odom (nav_msgs/Odometry)", "the columns pwm1, pwm2"
  std::vector<CandidateColumn> columns;  ///< as many as the part has; commands: those there are
  std::string frame{};
  int rank = 1;
  std::string why;
};

/// All that known_roles knows of in a log, best rank first; of several instances of one message
/// ("XKF1[0]", "XKF1[1]") the first. Names that are no UTF-8 or hold control characters are passed
/// over, for they can't be written.
std::vector<Candidate> find_candidates(const bag::BagReport& report);

/// Whether a name is UTF-8 without control characters.
bool can_be_written(std::string_view name);

}  // namespace kelpie::log
