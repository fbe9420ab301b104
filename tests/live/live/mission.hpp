// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "bag/bags.hpp"
#include "kelpie/core/random.hpp"

namespace kelpie::testing {

/// A geometry_msgs/TwistStamped with this stamp, whose linear.x is `x`.
inline Bytes twist_at(std::int64_t stamp_ns, double x) {
  CdrMessage message;
  message.header(static_cast<std::int32_t>(stamp_ns / kSecond),
                 static_cast<std::uint32_t>(stamp_ns % kSecond));
  message.add(x);
  for (int i = 0; i < 5; ++i) {
    message.add(0.0);
  }
  return message.bytes();
}

inline const std::vector<bag::Topic>& mission_topics() {
  static const std::vector<bag::Topic> topics{
      {.name = "/odom", .type = "geometry_msgs/msg/TwistStamped"},
      {.name = "/thruster", .type = "geometry_msgs/msg/TwistStamped"},
      {.name = "/camera", .type = "somewhere_msgs/msg/Unknown"},
  };
  return topics;
}

/// The same, with the measured acceleration of imu_config() in `/imu`.
inline std::vector<bag::Topic> imu_topics() {
  std::vector<bag::Topic> topics = mission_topics();
  topics.push_back({.name = "/imu", .type = "geometry_msgs/msg/TwistStamped"});
  return topics;
}

/// A little vehicle that moves along one axis for so long: its velocity at 20 Hz in /odom, its
/// thruster at 11 Hz in /thruster, and a topic that nobody can decode. Received 5 to 15 ms after
/// their stamps, in the order of being received. The rotor follows its command in `lag_s`. With a
/// unit (m/s²) of accelerations also /imu at 20 Hz.
inline std::vector<Recorded> little_mission(double seconds, std::uint64_t seed = 1,
                                            double lag_s = 0.0, double imu_unit = 0.0) {
  constexpr std::int64_t kBegin = 1'700'000'000 * kSecond;
  constexpr std::int64_t kStep = kSecond / 1000;
  RandomStream random(seed, "mission");
  std::vector<Recorded> messages;
  double u = 0.0;
  double phase = 0.0;
  double n = 0.0;
  double rotor = 0.0;
  for (int k = 0; k < static_cast<int>(1000.0 * seconds); ++k) {
    const std::int64_t stamp = kBegin + k * kStep;
    const auto received = [&] {
      return stamp + static_cast<std::int64_t>(random.uniform(5e6, 15e6));
    };
    if (k % 91 == 7) {
      phase += random.uniform(0.01, 0.05);
      n = 10.0 * std::sin(phase);
      messages.push_back({1, received(), twist_at(stamp, n)});
    }
    if (k % 50 == 3) {
      messages.push_back({0, received(), twist_at(stamp, u + random.uniform(-1e-3, 1e-3))});
    }
    if (k % 1000 == 500) {
      messages.push_back({2, received(), Bytes(64)});
    }
    rotor += lag_s > 0.0 ? 1e-3 * (n - rotor) / lag_s : n - rotor;
    const double udot = 0.01 * rotor * std::abs(rotor) - 2.0 * u * std::abs(u) - 0.3 * u;
    if (imu_unit != 0.0 && k % 50 == 13) {
      messages.push_back({3, received(), twist_at(stamp, udot / imu_unit)});
    }
    u += 1e-3 * udot;
  }
  std::ranges::stable_sort(messages, {}, &Recorded::receive_ns);
  return messages;
}

/// The configuration for it; `log` and `live` are more lines of these tables.
inline std::string mission_config(const std::string& log = "", const std::string& live = "") {
  return "buffer = 60\nanchors = 20\n"
         "[log]\ninputs = [\"u\", \"n\"]\ntargets = [\"udot\"]\nrate = 10\n" +
         log +
         "\n[log.states]\nu = \"/odom:twist.linear.x\"\n"
         "[log.commands]\nn = \"/thruster:twist.linear.x\"\n"
         "[log.derived]\nudot = \"d(u)\"\n[live]\n" +
         live + "\n";
}

/// The same with the acceleration of /imu as target.
inline std::string imu_config(const std::string& live = "") {
  return "buffer = 60\nanchors = 20\n"
         "[log]\ninputs = [\"u\", \"n\"]\ntargets = [\"udot\"]\nrate = 10\n"
         "[log.states]\nu = \"/odom:twist.linear.x\"\nudot = \"/imu:twist.linear.x\"\n"
         "[log.commands]\nn = \"/thruster:twist.linear.x\"\n[live]\n" +
         live + "\n";
}

}  // namespace kelpie::testing
