// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace kelpie::dds {

/// Behavioural constants of the DDS connection, chosen by hand; no measurement is recorded.
inline constexpr struct Tuning {
  std::size_t queued_samples = 1000;           ///< per topic, then the oldest is lost; docs/live.md
  std::uint32_t message_bytes = 1'000'000;     ///< longer messages are neither sent nor received
  std::uint32_t least_message_bytes = 10'000;  ///< discovery's own messages have to fit
  int participants_per_peer = 32;              ///< asked at each unicast peer, a port each
} kTuning;

}  // namespace kelpie::dds
