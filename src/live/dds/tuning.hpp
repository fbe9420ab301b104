// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace kelpie::dds {

/// Behavioural constants of the DDS connection, chosen by hand; no measurement is recorded.
inline constexpr struct Tuning {
  std::size_t queued_samples = 1000;           ///< per topic; the oldest is lost; howto/live.md
  std::size_t queued_bytes = 4'000'000;        ///< the same; 1,000 Odometry have 720,000
  std::size_t kept_bytes = 16'384;             ///< of memory, by a slot for its next message
  std::uint32_t message_bytes = 1'000'000;     ///< longer messages are neither sent nor received
  std::uint32_t least_message_bytes = 10'000;  ///< discovery's own messages have to fit
  std::size_t most_mismatches = 8;             ///< told of a topic; others can make any number
  int participants_per_peer = 32;              ///< asked at each unicast peer, a port each
} kTuning;

}  // namespace kelpie::dds
