// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dds/entity.hpp"
#include "dds/network.hpp"
#include "dds/quality.hpp"

namespace kelpie::dds {

/// A publisher or subscriber that is there now, anywhere in the domain.
struct Endpoint {
  bool publishes = false;
  bool own = false;      ///< of this process
  std::string topic;     ///< "/odom"
  std::string type;      ///< "nav_msgs/msg/Odometry"
  Quality quality;       ///< that it offers or asks for
  std::uint64_t id = 0;  ///< Cyclone DDS's number for it
};

/// This process's place in a DDS domain. Where it listens and whom it talks to is told by Network
/// and nothing else.
class Participant {
 public:
  /// Opens sockets and starts the library's threads. Throws InputError (what is wrong with
  /// `network`), Failure with the library's words: no such interface, no port left, a second
  /// participant of one domain in this process.
  explicit Participant(const Network& network);

  /// All topics of ROS 2 with a publisher or subscriber, as far as they have been found: others
  /// take some hundred milliseconds to be found, and as long as they like to appear.
  std::vector<Endpoint> endpoints() const;

  std::int32_t number() const { return participant_.number(); }  ///< For what belongs to it.

 private:
  Entity domain_;
  Entity participant_;
  Entity publications_;  // readers of what is there
  Entity subscriptions_;
};

}  // namespace kelpie::dds
