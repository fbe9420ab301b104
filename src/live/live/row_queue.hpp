// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "live/requests.hpp"

namespace kelpie::live {

/// A row for the learner, or a request to obey between two rows.
struct Row {
  double t = 0.0;              ///< [s] since the origin
  std::int64_t origin_ns = 0;  ///< by the configuration's clock
  std::vector<double> x;
  std::vector<double> y;
  bool is_stuck = false;         ///< a velocity of the row is stuck
  bool wants_model = false;      ///< the model before the row is wanted for dead reckoning
  std::int64_t received_ns = 0;  ///< of the message that completed the row, by the recorder's clock
  std::chrono::steady_clock::time_point came;  ///< the same by this machine's clock
  std::optional<Request> request{};            ///< if set, all other members are void
};

/// First-in first-out queue of rows between two threads. Allocates nothing after construction for
/// rows with the sizes of `like`.
class RowQueue {
 public:
  using Clock = std::chrono::steady_clock;

  RowQueue(std::size_t capacity, const Row& like) : ring_(capacity, like) {}

  /// Adds a row. Where the queue is full, waits for room (`wait`) or drops and counts the row.
  /// Returns whether the row was added; false after close().
  bool push(const Row& row, bool wait);

  /// Takes the oldest row; waits for one. False once closed and empty.
  bool pop(Row& row);

  /// Ends push() and waiting. From `until` on the waiting rows are dropped, but not the requests.
  void close(Clock::time_point until = Clock::time_point::max());

  std::size_t size() const;
  bool has_request() const;     ///< whether a request waits
  std::size_t dropped() const;  ///< since construction

 private:
  void remove_first();

  mutable std::mutex mutex_;
  std::condition_variable added_;
  std::condition_variable taken_;
  std::vector<Row> ring_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::size_t requests_ = 0;  // among the rows
  std::size_t dropped_ = 0;
  Clock::time_point until_ = Clock::time_point::max();
  bool is_closed_ = false;
};

}  // namespace kelpie::live
