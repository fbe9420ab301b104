// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "live/output.hpp"

namespace kelpie::web {

/// An event and its time by this machine's clock.
struct Line {
  std::int64_t at_ms = 0;  ///< since 1970
  std::string text;        ///< printable
};

/// Data of the page in bounded memory: the last samples, health and events. For any threads; a
/// reader blocks a writer for no longer than the copy of one block.
class Feed {
 public:
  static constexpr std::size_t kPerAxis = 4;  ///< measured, predicted, lower, upper

  /// Keeps the last `capacity` samples of so many axes.
  Feed(std::size_t axes, std::size_t capacity);

  void add(const live::LearnedSample& sample);
  void add(const live::Health& health);
  void add(const std::string& line);
  void end();  ///< The recording has ended: nothing is added any more.

  std::size_t row_size() const { return 1 + kPerAxis * axes_; }

  // Data behind `next`, a reader's position: 0 at first, moved by each call. Data no longer kept
  // are skipped.

  /// Samples in sequence, at most Tuning::block_rows: time [s], then kPerAxis values per axis; NaN:
  /// unknown.
  std::vector<double> rows(std::uint64_t& next) const;
  std::vector<Line> lines(std::uint64_t& next) const;
  std::shared_ptr<const live::Health> health() const;  ///< The latest; null before the first.
  bool has_ended() const;

 private:
  std::size_t axes_;
  std::size_t capacity_;
  mutable std::mutex mutex_;
  std::vector<double> ring_;
  std::uint64_t rows_ = 0;  // total
  std::deque<Line> lines_;
  std::uint64_t line_count_ = 0;  // total
  std::shared_ptr<const live::Health> health_;
  bool has_ended_ = false;
};

}  // namespace kelpie::web
