// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "log/candidates.hpp"

namespace kelpie::log {

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

}  // namespace kelpie::log
