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

/// A row on its way to the learner; or a request, which it obeys between two rows.
struct Row {
  double t = 0.0;              ///< [s] since the origin
  std::int64_t origin_ns = 0;  ///< by the clock of the configuration
  std::vector<double> x;
  std::vector<double> y;
  bool is_stuck = false;         ///< a velocity in it doesn't change any more
  std::int64_t received_ns = 0;  ///< of the message that completed it, by the recorder's clock
  std::chrono::steady_clock::time_point came;  ///< the same by ours
  std::optional<Request> request{};            ///< then nothing above is of use
};

/// Rows between two threads, first in, first out. Nothing allocates after construction where rows
/// have the sizes of `like`.
class RowQueue {
 public:
  RowQueue(std::size_t most, const Row& like) : ring_(most, like) {}

  /// Adds a row. Where it is full it waits for room, or drops the row and counts it. Returns
  /// whether it was added; false for all once closed.
  bool push(const Row& row, bool wait);

  /// Takes the first one, for which it waits; false once it is closed and empty.
  bool pop(Row& row);

  void close();  ///< No more will be added.

  std::size_t size() const;
  std::size_t dropped() const;  ///< since construction

 private:
  mutable std::mutex mutex_;
  std::condition_variable added_;
  std::condition_variable taken_;
  std::vector<Row> ring_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::size_t dropped_ = 0;
  bool is_closed_ = false;
};

}  // namespace kelpie::live
