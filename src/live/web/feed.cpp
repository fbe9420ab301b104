// SPDX-License-Identifier: Apache-2.0
#include "web/feed.hpp"

#include <algorithm>
#include <chrono>

#include "chart/wording.hpp"
#include "web/tuning.hpp"

namespace kelpie::web {
Feed::Feed(std::size_t axes, std::size_t capacity)
    : axes_(axes), capacity_(capacity), ring_((1 + kPerAxis * axes) * capacity) {}

void Feed::add(const live::LearnedSample& sample) {
  const std::lock_guard lock(mutex_);
  double* value = ring_.data() + static_cast<std::size_t>(rows_ % capacity_) * row_size();
  *value++ = sample.t;
  for (std::size_t i = 0; i < axes_; ++i) {
    const Decision& said = sample.decisions[i];
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    *value++ = sample.y[i];
    *value++ = said.had_model ? said.prediction.value : kNone;
    *value++ = said.had_model ? said.prediction.lower : kNone;
    *value++ = said.had_model ? said.prediction.upper : kNone;
  }
  ++rows_;
}

void Feed::add(const live::Health& health) {
  auto copy = std::make_shared<const live::Health>(health);
  const std::lock_guard lock(mutex_);
  health_.swap(copy);
}

void Feed::add(const std::string& line) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  Line said{.at_ms = std::chrono::duration_cast<std::chrono::milliseconds>(now).count(),
            .text = chart::shortened(line, kTuning.line_letters)};
  const std::lock_guard lock(mutex_);
  lines_.push_back(std::move(said));
  ++line_count_;
  if (lines_.size() > kTuning.lines) {
    lines_.pop_front();
  }
}

void Feed::end() {
  const std::lock_guard lock(mutex_);
  has_ended_ = true;
}

bool Feed::has_ended() const {
  const std::lock_guard lock(mutex_);
  return has_ended_;
}

std::vector<double> Feed::rows(std::uint64_t& next) const {
  const std::lock_guard lock(mutex_);
  std::vector<double> rows;
  const std::uint64_t first = rows_ > capacity_ ? rows_ - capacity_ : 0;
  next = std::clamp(next, first, rows_);
  const std::uint64_t end = std::min(rows_, next + kTuning.block_rows);
  rows.reserve(static_cast<std::size_t>(end - next) * row_size());
  for (; next < end; ++next) {
    const double* const row =
        ring_.data() + static_cast<std::size_t>(next % capacity_) * row_size();
    rows.insert(rows.end(), row, row + row_size());
  }
  return rows;
}

std::vector<Line> Feed::lines(std::uint64_t& next) const {
  const std::lock_guard lock(mutex_);
  const std::uint64_t first = line_count_ - lines_.size();
  const auto from = static_cast<std::ptrdiff_t>(std::clamp(next, first, line_count_) - first);
  next = line_count_;
  return {lines_.begin() + from, lines_.end()};
}

std::shared_ptr<const live::Health> Feed::health() const {
  const std::lock_guard lock(mutex_);
  return health_;
}

}  // namespace kelpie::web
