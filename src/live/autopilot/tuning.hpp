// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace kelpie::autopilot {

/// Behavioural constants of the link to an autopilot. howto/live.md describes the times and rates;
/// they were chosen by hand, after ArduSub's own, and no measurement is recorded.
inline constexpr struct Tuning {
  // Link
  std::chrono::seconds between_heartbeats{1};  ///< of ours; MAVLink's usual rate
  std::chrono::seconds longest_silence{5};     ///< of the vehicle's HEARTBEAT, until a fault
  std::chrono::seconds longest_check{3};       ///< for `--check` to find the vehicle
  std::size_t bytes_without_frame = 2'000;     ///< until the baud rate is suspected
  std::chrono::seconds longest_trial{5};       ///< of an autopilot without data, until the next
  std::chrono::seconds fault_memory{60};       ///< of a fault that others cause; keeps events rare
  std::size_t most_senders = 32;               ///< heard at a time; docs/reference/limits.md
  std::size_t most_topics = 1'000;             ///< of senders that [log] does not name
  std::chrono::seconds between_tries{1};       ///< to open an unplugged serial line

  // Signatures
  std::uint64_t oldest_signature = 6'000'000;  ///< [10 µs] of a new sender: MAVLink's minute
  std::size_t key_bytes = 4'096;               ///< of a file with a key
  std::size_t most_streams = 16;               ///< signing senders, as in MAVLink's library in C

  // Rates of messages
  double rate_factor = 2.0;      ///< messages per row, for a line through messages; howto/live.md
  double most_rate_hz = 1000.0;  ///< of [live.mavlink] rates
  std::chrono::seconds between_measurements{3};  ///< of the rates
  std::chrono::seconds longest_answer{1};        ///< until the next request; docs/howto/live.md
  std::chrono::seconds between_requests{5};      ///< of one message; docs/howto/live.md
  double enough = 0.8;  ///< of the requested rate: schedulers round; docs/howto/live.md

  // Parameters
  std::chrono::milliseconds between_parameters{500};  ///< of one request without an answer
  std::chrono::seconds longest_introduction{20};      ///< of a vehicle without a configuration
  int most_asked = 10;  ///< requests of one parameter: another autopilot may not have it

  // Reports
  std::chrono::milliseconds between_values{200};     ///< docs/howto/live.md
  std::chrono::milliseconds between_velocities{50};  ///< ArduSub takes a velocity log at 20 Hz
  double longest_delta_s = 1.0;                      ///< s; ArduPilot drops older ways
  std::chrono::seconds between_texts{1};             ///< docs/howto/live.md
  std::size_t most_texts = 8;                        ///< waiting; further ones are dropped
  std::size_t pieces = 4;                            ///< of a text; the rest is cut
} kTuning;

}  // namespace kelpie::autopilot
