// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace kelpie::dds {

/// Where to listen and whom to talk to.
struct Network {
  static constexpr std::uint32_t kMostDomain = 232;  ///< higher ones have no port left

  std::uint32_t domain = 0;          ///< 0 … kMostDomain
  std::string interface {};          ///< "eth0" or an address of it; empty: the library chooses one
  std::vector<std::string> peers{};  ///< addresses or host names, asked by unicast
  bool multicast = true;             ///< for finding others and for data
  std::uint32_t most_message_bytes = 1'000'000;  ///< longer messages are neither taken nor sent
  /// More of Cyclone DDS's own configuration, such as its Security: XML, or "file://…" of one. What
  /// is set above takes the place of what it says.
  std::string configuration{};

  /// ROS_DOMAIN_ID and CYCLONEDDS_URI, as ROS 2 takes them. Throws InputError (ROS_DOMAIN_ID) on
  /// what is no domain.
  static Network from_environment();
  /// CYCLONEDDS_URI alone; empty where there is none.
  static std::string configuration_of_environment();

  /// Only this machine: interface lo, no multicast, the one peer 127.0.0.1.
  static Network loopback(std::uint32_t domain);

  bool operator==(const Network&) const = default;
};

/// The names and addresses of this machine's network interfaces.
std::vector<std::string> interfaces_here();

/// The string that Cyclone DDS is configured with. Throws InputError (domain, interface, peers,
/// largest message) on what is none.
std::string cyclone_configuration(const Network& network);

}  // namespace kelpie::dds
