// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

struct dds_qos;

namespace kelpie::dds {

/// The quality of service of a topic, as far as ROS 2 lets one choose it. A subscription gets what
/// it asks for or more: best effort is content with a reliable publisher, not the other way round.
struct Quality {
  bool reliable = false;         ///< messages that got lost are sent again
  bool transient_local = false;  ///< whoever comes late gets the last messages
  std::int32_t depth = 5;        ///< messages kept for that, and for who is slow; at least 1
  std::string partition{};       ///< empty: the one without a name, where ROS 2 is

  /// ROS 2's "sensor data": best effort, five messages, volatile.
  static Quality sensor_data() { return {}; }
  /// ROS 2's default: reliable, ten messages, volatile.
  static Quality standard() { return {.reliable = true, .depth = 10}; }

  bool operator==(const Quality&) const = default;
};

/// Cyclone DDS's object for it.
using QosPointer = std::unique_ptr<dds_qos, void (*)(dds_qos*)>;
QosPointer qos_of(const Quality& quality);

/// What of an endpoint's object ROS 2 users know.
Quality quality_of(const dds_qos* qos);

/// "reliability", "durability", … of Cyclone DDS's number for a policy.
std::string policy_name(std::uint32_t policy);

}  // namespace kelpie::dds
