// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

struct dds_qos;

namespace kelpie::dds {

/// Quality of service of a topic, as far as ROS 2 offers a choice. A publisher must offer at least
/// the requested quality: a reliable publisher serves a best-effort subscription, not vice versa.
struct Quality {
  bool reliable = false;         ///< lost messages are sent again
  bool transient_local = false;  ///< late subscribers get the last messages
  std::int32_t depth = 5;        ///< messages kept for late and slow subscribers; at least 1
  std::string partition{};       ///< empty: the unnamed one, ROS 2's default

  /// ROS 2's "sensor data": best effort, five messages, volatile.
  static Quality sensor_data() { return {}; }
  /// ROS 2's default: reliable, ten messages, volatile.
  static Quality standard() { return {.reliable = true, .depth = 10}; }

  bool operator==(const Quality&) const = default;
};

/// Cyclone DDS's object of a Quality.
using QosPointer = std::unique_ptr<dds_qos, void (*)(dds_qos*)>;
QosPointer qos_of(const Quality& quality);

/// Quality of an endpoint's object.
Quality quality_of(const dds_qos* qos);

/// Name of a policy ("reliability", "durability", …) by Cyclone DDS's number.
std::string policy_name(std::uint32_t policy);

}  // namespace kelpie::dds
