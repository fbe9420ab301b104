// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>

namespace kelpie::web {

/// Behavioural constants of the page. docs/howto/live.md promises the limits; the other values were
/// chosen by hand and no measurement is recorded.
inline constexpr struct Tuning {
  std::size_t connection_bytes = 16'384;  ///< of a request's head with its index; howto/live.md
  std::size_t body_bytes = 4'096;         ///< most bytes of a body, which is dropped; howto/live.md
  std::chrono::seconds longest_request{10};       ///< [s] from the connection to the whole answer
  std::chrono::milliseconds between_events{100};  ///< between two texts to a reader
  std::chrono::milliseconds farewell{800};        ///< for the last texts to readers
  std::size_t streams = 8;                        ///< readers of /events at a time; howto/live.md
  std::size_t stream_bytes = 4'096;               ///< of a text in one piece
  std::size_t guests = 32;                        ///< other connections at a time; howto/live.md
  std::size_t leaving = 16;        ///< closed connections that the library has yet to forget
  int backlog = 64;                ///< connections that wait for the page's thread
  int niceness = 10;               ///< of the page's thread above the learner's
  double window_s = 300.0;         ///< [s] of samples kept and shown; docs/howto/live.md
  double most_samples = 12'000;    ///< samples kept: a minute at 200 Hz; docs/howto/live.md
  std::size_t block_rows = 256;    ///< rows copied at a time, while the learner cannot add
  std::size_t text_rows = 3'072;   ///< samples in one text, some 100 kB per axis
  std::size_t topics = 4;          ///< named as the source of a run
  std::size_t lines = 200;         ///< lines of events kept
  std::size_t line_letters = 500;  ///< letters kept of a line
} kTuning;

}  // namespace kelpie::web
