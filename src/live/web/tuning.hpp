// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>

namespace kelpie::web {

/// Behavioural constants of the page. docs/live.md promises the limits; the other values were
/// chosen by hand and no measurement is recorded.
inline constexpr struct Tuning {
  std::size_t request_bytes = 16384;              ///< most bytes of a request; docs/live.md
  std::chrono::seconds longest_request{10};       ///< [s] to receive a request; docs/live.md
  std::chrono::seconds longest_write{5};          ///< [s] without any byte taken, until hanging up
  std::chrono::milliseconds stop_check{100};      ///< between two checks for the end of the program
  std::size_t streams = 8;                        ///< readers of /events at a time; docs/live.md
  std::size_t others = 4;                         ///< other requests at a time; docs/live.md
  std::chrono::milliseconds between_events{100};  ///< between two texts to a reader
  double window_s = 300.0;                        ///< [s] of samples kept and shown; docs/live.md
  double most_samples = 12'000;    ///< samples kept: a minute at 200 Hz; docs/live.md
  std::size_t lines = 200;         ///< lines of events kept
  std::size_t line_letters = 500;  ///< letters kept of a line
} kTuning;

}  // namespace kelpie::web
