// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "dds/message_queue.hpp"
#include "dds/participant.hpp"

namespace kelpie::dds {

/// Puts the messages of one topic into a queue as they come, undecoded: their type is only a name
/// that has to be that of the publisher's.
class Subscription {
 public:
  /// `topic` and `type` are ROS 2's ("/odom", "nav_msgs/msg/Odometry"). Messages carry `tag` as
  /// TopicSample::topic. Requires that participant and queue outlive this.
  /// Throws InputError on what is no name, Failure where the library can't.
  Subscription(const Participant& participant, const std::string& topic, const std::string& type,
               const Quality& quality, MessageQueue& queue, std::size_t tag);
  ~Subscription();
  Subscription(const Subscription&) = delete;
  Subscription& operator=(const Subscription&) = delete;

  std::size_t publishers() const;  ///< That are connected now.
  std::uint64_t received() const;  ///< Messages that came.
  std::uint64_t lost() const;      ///< Messages that the library knows were sent and didn't come.

  /// Why others publish this topic and nothing comes of it, a sentence each: another type, a policy
  /// of their quality of service, another partition. Empty: nothing stands between.
  std::vector<std::string> mismatches() const;

 private:
  struct Reception;
  std::unique_ptr<Reception> reception_;
};

}  // namespace kelpie::dds
