// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "dds/participant.hpp"

struct ddsi_sertype;

namespace kelpie::dds {

/// A topic of this process: the common part of Publication and Subscription.
class TopicEnd {
 public:
  /// `own` has names of ROS 2 ("/odom", "nav_msgs/msg/Odometry"). Throws InputError on other names,
  /// Failure on errors of the library.
  TopicEnd(const Participant& participant, const Endpoint& own);

  const Endpoint& own() const { return own_; }
  std::int32_t number() const { return topic_.number(); }
  const ddsi_sertype* type() const { return type_; }

  /// Subscription::mismatches of the reader or writer with number `end`.
  std::vector<std::string> mismatches(std::int32_t end) const;

 private:
  std::string mismatch(std::int32_t end, const Endpoint& other) const;

  const Participant& participant_;
  Endpoint own_;
  ddsi_sertype* type_ = nullptr;  // the library's
  Entity topic_;
};

}  // namespace kelpie::dds
