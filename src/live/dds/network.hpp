// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dds/tuning.hpp"

namespace kelpie::dds {

/// Network settings of a participant.
struct Network {
  static constexpr std::uint32_t kMostDomain = 232;  ///< a higher domain has no port

  std::uint32_t domain = 0;          ///< 0 … kMostDomain
  std::string interface {};          ///< "eth0" or its address; empty: the library's choice
  std::vector<std::string> peers{};  ///< addresses or host names, for unicast discovery
  bool multicast = true;             ///< for discovery and data
  std::uint32_t most_message_bytes = kTuning.message_bytes;
  /// Further configuration of Cyclone DDS, such as Security: XML, or "file://…". The members above
  /// have precedence.
  std::string configuration{};

  /// Settings of ROS_DOMAIN_ID and CYCLONEDDS_URI, as in ROS 2. Throws InputError (ROS_DOMAIN_ID)
  /// on an invalid domain.
  static Network from_environment();
  /// CYCLONEDDS_URI; empty where unset.
  static std::string configuration_of_environment();

  /// This machine alone: interface lo, no multicast, peer 127.0.0.1.
  static Network loopback(std::uint32_t domain);

  bool operator==(const Network&) const = default;
};

/// Names and addresses of this machine's network interfaces.
std::vector<std::string> interfaces_here();

/// Configuration of Cyclone DDS in XML. Throws InputError (domain, interface, peers, largest
/// message) on invalid settings.
std::string cyclone_configuration(const Network& network);

}  // namespace kelpie::dds
