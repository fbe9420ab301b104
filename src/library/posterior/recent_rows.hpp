// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// The latest rows of an axis and what is to be done with each, in a ring: rows are numbered from
/// the first on, and kept from begin() to end(). Allocates in the constructor only.
class RecentRows {
 public:
  struct Row {
    std::span<const double> x;
    double y;     ///< the target
    double left;  ///< the target less what was known beforehand
    double t;     ///< [s]
  };
  enum class State : std::uint8_t {
    done,      ///< learned, or never to be learned
    dropped,   ///< not to be learned
    waits,     ///< until rows like this one are judged
    due,       ///< to be learned
    due_rare,  ///< to be learned as a row of a rare manoeuvre
  };

  RecentRows(std::size_t inputs, std::size_t capacity)
      : inputs_(inputs), numbers_(capacity * (inputs + 3)), states_(capacity) {}

  std::size_t begin() const { return begin_; }
  std::size_t end() const { return end_; }
  bool full() const { return end_ - begin_ == states_.size(); }

  /// The oldest row of a full ring goes.
  void push(const Row& row, State state) {
    begin_ += full() ? 1 : 0;
    const std::span<double> place = numbers(end_);
    std::ranges::copy(row.x, place.begin());
    place[inputs_] = row.y;
    place[inputs_ + 1] = row.left;
    place[inputs_ + 2] = row.t;
    states_[end_ % states_.size()] = state;
    ++end_;
  }

  Row operator[](std::size_t i) {
    const std::span<const double> place = numbers(i);
    return {place.first(inputs_), place[inputs_], place[inputs_ + 1], place[inputs_ + 2]};
  }
  State& state(std::size_t i) { return states_[i % states_.size()]; }

  void clear() { begin_ = end_; }

  void visit(Archive& archive) {  ///< core/archive.hpp
    archive.whole(begin_);
    archive.whole(end_, begin_, begin_ + states_.size());
    for (std::size_t i = begin_; i < end_; ++i) {
      archive.numbers(numbers(i));
      archive.choice(state(i), State::done, State::due_rare);
    }
  }

  /// Memory in bytes.
  static std::size_t bytes(std::size_t inputs, std::size_t capacity) {
    return capacity * ((inputs + 3) * sizeof(double) + sizeof(State));
  }

 private:
  std::span<double> numbers(std::size_t i) {
    return std::span(numbers_).subspan(i % states_.size() * (inputs_ + 3), inputs_ + 3);
  }

  std::size_t inputs_;
  std::size_t begin_ = 0, end_ = 0;
  std::vector<double> numbers_;
  std::vector<State> states_;
};

}  // namespace kelpie
