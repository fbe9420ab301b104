// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "dds/message_queue.hpp"
#include "dds/participant.hpp"

namespace kelpie::dds {

/// Receives the undecoded messages of one topic into a queue. The type is a name only, the same as
/// the publisher's.
class Subscription {
 public:
  /// `topic` and `type` are names of ROS 2 ("/odom", "nav_msgs/msg/Odometry"); `tag` becomes
  /// TopicSample::topic. Messages of more than `most_bytes` are counted and dropped. Requires that
  /// participant and queue outlive this. Throws InputError on invalid names, Failure on errors of
  /// the library.
  Subscription(const Participant& participant, const std::string& topic, const std::string& type,
               const Quality& quality, MessageQueue& queue, std::size_t tag,
               std::size_t most_bytes = kTuning.message_bytes);
  ~Subscription();
  Subscription(const Subscription&) = delete;
  Subscription& operator=(const Subscription&) = delete;

  std::size_t publishers() const;  ///< Connected now.
  std::uint64_t received() const;  ///< Messages received.
  std::uint64_t lost() const;      ///< Messages lost on the way, by the library's count.
  std::uint64_t too_long() const;  ///< Messages of more than `most_bytes`.

  /// Why publishers of this topic don't match, a sentence each: type, quality of service,
  /// partition. Empty: all match.
  std::vector<std::string> mismatches() const;

 private:
  struct Reception;
  std::unique_ptr<Reception> reception_;
};

}  // namespace kelpie::dds
