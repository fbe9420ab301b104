// SPDX-License-Identifier: Apache-2.0
#include "svr/watch_list.hpp"

#include <algorithm>

#include "core/vector.hpp"

namespace kelpie {

WatchList::WatchList(std::size_t places, std::size_t capacity)
    : places_(std::min(places, capacity)),
      stride_(capacity),
      place_(capacity, kNowhere),
      column_(capacity, kNowhere),
      values_(places_ * stride_),
      column_values_(places_),
      move_(capacity) {
  watched_.reserve(places_);
  movers_.reserve(capacity);
}

std::size_t WatchList::bytes(std::size_t places, std::size_t capacity) {
  const std::size_t watched = std::min(places, capacity);
  constexpr std::size_t kNumbers = sizeof(std::size_t) + 2 * sizeof(std::ptrdiff_t);
  return watched * (sizeof(std::size_t) + (capacity + 1) * sizeof(double)) +
         capacity * (kNumbers + sizeof(double));
}

void WatchList::watch(const KernelMatrix& kernel, std::size_t sample) {
  kernel.gather(sample, movers_, {row(watched_.size()), movers_.size()});
  place_[sample] = static_cast<std::ptrdiff_t>(watched_.size());
  watched_.push_back(sample);
}

void WatchList::unwatch(std::size_t sample) {
  const auto place = static_cast<std::size_t>(place_[sample]);
  const std::size_t last = watched_.back();
  std::copy_n(row(watched_.size() - 1), movers_.size(), row(place));
  watched_[place] = last;
  place_[last] = static_cast<std::ptrdiff_t>(place);
  place_[sample] = kNowhere;
  watched_.pop_back();
}

void WatchList::add_mover(const KernelMatrix& kernel, std::size_t sample) {
  const std::size_t column = movers_.size();
  kernel.gather(sample, watched_, std::span(column_values_).first(watched_.size()));
  for (std::size_t k = 0; k < watched_.size(); ++k) {
    row(k)[column] = column_values_[k];
  }
  column_[sample] = static_cast<std::ptrdiff_t>(movers_.size());
  movers_.push_back(sample);
}

void WatchList::remove_mover(std::size_t sample) {
  const auto column = static_cast<std::size_t>(column_[sample]);
  const std::size_t last = movers_.size() - 1;
  for (std::size_t k = 0; k < watched_.size(); ++k) {
    row(k)[column] = row(k)[last];
  }
  movers_[column] = movers_[last];
  column_[movers_[column]] = static_cast<std::ptrdiff_t>(column);
  column_[sample] = kNowhere;
  movers_.pop_back();
}

void WatchList::renumber(std::size_t from, std::size_t to) {
  if (from == to) {
    return;
  }
  place_[to] = place_[from];
  column_[to] = column_[from];
  place_[from] = kNowhere;
  column_[from] = kNowhere;
  if (place_[to] != kNowhere) {
    watched_[static_cast<std::size_t>(place_[to])] = to;
  }
  if (column_[to] != kNowhere) {
    movers_[static_cast<std::size_t>(column_[to])] = to;
  }
}

void WatchList::clear() {
  std::ranges::fill(place_, kNowhere);
  std::ranges::fill(column_, kNowhere);
  watched_.clear();
  movers_.clear();
}

void WatchList::visit(Archive& archive, const KernelMatrix& kernel) {
  const auto samples = [&](std::vector<std::size_t>& list, std::vector<std::ptrdiff_t>& place,
                           std::size_t most) {
    std::size_t next = 0;
    archive.list(list, std::min(most, kernel.size()), [&](std::size_t& sample) {
      archive.whole(sample);
      archive.require(sample < kernel.size(), "has a sample that there isn't");
      if (archive.loading()) {
        archive.require(place[sample] == kNowhere, "has a sample twice");
        place[sample] = static_cast<std::ptrdiff_t>(next++);
      }
    });
  };
  samples(movers_, column_, stride_);
  samples(watched_, place_, places_);
  for (std::size_t k = 0; archive.loading() && k < watched_.size(); ++k) {
    kernel.gather(watched_[k], movers_, {row(k), movers_.size()});
  }
}

void WatchList::products(std::span<const double> d, std::span<double> out) const {
  const std::span<double> move = std::span(move_).first(movers_.size());
  for (std::size_t k = 0; k < movers_.size(); ++k) {
    move[k] = d[movers_[k]];
  }
  std::size_t k = 0;
  for (; k + 4 <= watched_.size(); k += 4) {
    std::ranges::copy(dot(Four<double>{row(k), row(k + 1), row(k + 2), row(k + 3)}, move),
                      out.begin() + static_cast<std::ptrdiff_t>(k));
  }
  for (; k < watched_.size(); ++k) {
    out[k] = dot({row(k), movers_.size()}, move);
  }
}

}  // namespace kelpie
