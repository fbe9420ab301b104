// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bag/inspect.hpp"
#include "log/known_roles.hpp"

namespace kelpie::log {

/// A signal of a log, as part of a candidate.
struct CandidateColumn {
  std::string name;   ///< "/odom:twist.twist.linear.x", or a CSV column; "": missing
  std::string topic;  ///< of the bag
  std::string unit{};
  double low = 0.0;
  double high = 0.0;
  double rate_hz = 0.0;
  std::optional<bag::ClockOffset> stamps{};  ///< empty: no time stamps by the sender

  bool exists() const { return !name.empty(); }
  bool varies() const { return exists() && high > low; }
};

/// A possible velocity, rotation, attitude or set of commands of a log.
struct Candidate {
  Part part = Part::velocity;
  std::string what;  ///< "/odom (nav_msgs/Odometry)", "the columns pwm1, pwm2"
  std::vector<CandidateColumn>
      columns;  ///< as many as the part needs; commands: the existing columns
  std::string frame{};
  int rank = 1;
  std::string why;
};

/// A topic's field as [log] names a column; without a name where no value is finite.
CandidateColumn column_of(const bag::TopicReport& topic, const bag::FieldRange& field);

/// Finds the candidates of a log with the tables of known_roles, sorted by rank; of several
/// instances of a message ("XKF1[0]", "XKF1[1]") only the first. Names with control characters or
/// broken UTF-8 are skipped, because a configuration cannot hold such names.
std::vector<Candidate> find_candidates(const bag::BagReport& report);

/// Columns of a pose by part: x, y, z, roll, pitch, yaw or qw, qx, qy, qz.
using PoseColumns = std::map<std::string, CandidateColumn>;

/// The pose of a recording with the most parts, and the topics with as many.
struct PoseChoice {
  PoseColumns parts{};
  std::vector<std::string> rivals{};
};

/// Part and column of a text of Roles::pose: "x" names the column x, "yaw=psi" the column psi. The
/// part is "" where the text names none.
std::pair<std::string, std::string> pose_part(const std::string& text);

/// Finds a pose by names of fields. A pose has x and y together, with a yaw or a quaternion, and
/// moves. Wishes, velocities and references are passed over. Allocates.
PoseChoice choose_pose(const bag::BagReport& report);

/// Whether a name is UTF-8 without control characters.
bool can_be_written(std::string_view name);

/// "nav_msgs/Odometry" of "nav_msgs/msg/Odometry".
std::string short_type(std::string type);

/// The name as a text of TOML. Requires can_be_written().
std::string toml_text(std::string_view name);

}  // namespace kelpie::log
