// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "bag/bags.hpp"
#include "kelpie/core/random.hpp"
#include "log/pose_log.hpp"

namespace kelpie::testing {

inline const std::vector<bag::Topic>& pose_topics() {
  static const std::vector<bag::Topic> topics{
      {.name = "/mocap", .type = "geometry_msgs/msg/PoseStamped"},
      {.name = "/thrusters", .type = "std_msgs/msg/Float64MultiArray"},
  };
  return topics;
}

/// The messages of a drive: poses with a quaternion at 10 Hz in /mocap, with white noise of the
/// position, and commands n and m in /thrusters, 4 ms later. Times of reception begin at
/// `begin_ns`.
inline std::vector<Recorded> pose_mission(const PoseLog& log, std::int64_t begin_ns,
                                          double noise_m) {
  RandomStream random(7, "mocap");
  std::vector<Recorded> messages;
  for (const PoseLog::Sample& one : log.samples) {
    const std::int64_t stamp = begin_ns + std::llround(1e9 * one.t);
    CdrMessage pose;
    pose.header(static_cast<std::int32_t>(stamp / kSecond),
                static_cast<std::uint32_t>(stamp % kSecond));
    pose.add(one.x + noise_m * random.normal()).add(one.y + noise_m * random.normal()).add(0.0);
    pose.add(0.0).add(0.0).add(std::sin(0.5 * one.psi)).add(std::cos(0.5 * one.psi));
    messages.push_back({0, stamp, pose.bytes()});
    messages.push_back({1, stamp + kSecond / 250, float_array({one.n, one.m})});
  }
  return messages;
}

/// The configuration for it; `log` and `live` are more lines of these tables.
inline std::string pose_config(const std::string& log = "window = 3",
                               const std::string& live = "") {
  std::string text =
      "buffer = 60\nanchors = 20\n[log]\nrate = 5\ntargets = [\"udot\", \"vdot\", "
      "\"rdot\"]\ninputs = [\"u\", \"v\", \"r\", "
      "\"n\", \"m\"]\npose = {";
  for (const char* const axis : {"x", "y", "z"}) {
    text += std::string(axis) + " = \"/mocap:pose.position." + axis + "\", ";
  }
  for (const char* const part : {"w", "x", "y", "z"}) {
    text += std::string("q") + part + " = \"/mocap:pose.orientation." + part + "\"" +
            (*part == 'z' ? "}\n" : ", ");
  }
  return text + log +
         "\n[log.commands]\nn = \"/thrusters:data[0]\"\nm = \"/thrusters:data[1]\"\n[live]\n" +
         live + "\n";
}

}  // namespace kelpie::testing
