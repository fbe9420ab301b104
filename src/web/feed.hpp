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

/// Something that was said, and when by this machine's clock.
struct Line {
  std::int64_t at_ms = 0;  ///< since 1970
  std::string text;        ///< printable
};

/// What there is to see: the last samples, how things are, what was said. Everything in memory that
/// doesn't grow; for any threads, none of which holds another up for longer than a copy takes.
class Feed {
 public:
  static constexpr std::size_t kLines = 200;  ///< that are kept
  static constexpr std::size_t kPerAxis = 4;  ///< measured, predicted, lower, upper

  /// Keeps the last `most` samples of so many axes.
  Feed(std::size_t axes, std::size_t most);

  void add(const live::LearnedSample& sample);
  void add(const live::Health& health);
  void add(const std::string& line);

  std::size_t row_size() const { return 1 + kPerAxis * axes_; }
  std::size_t most() const { return most_; }

  // What is new for a reader, who keeps the number `next` of what he wants next; 0 at first. What
  // is no longer kept is lost to him.

  /// Samples one after the other: time [s], then four values per axis, NaN where there is none.
  std::vector<double> rows(std::uint64_t& next) const;
  std::vector<Line> lines(std::uint64_t& next) const;
  std::shared_ptr<const live::Health> health() const;  ///< The latest; null: none yet.

 private:
  std::size_t axes_;
  std::size_t most_;
  mutable std::mutex mutex_;
  std::vector<double> ring_;
  std::uint64_t rows_ = 0;  // ever
  std::deque<Line> lines_;
  std::uint64_t said_ = 0;  // lines, ever
  std::shared_ptr<const live::Health> health_;
};

}  // namespace kelpie::web
