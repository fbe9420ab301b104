// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// Finds signals that have stopped: a number that comes again and again, for far longer than it
/// ever did, while others move.
class Standstill {
 public:
  /// Watches these of the inputs.
  explicit Standstill(std::vector<std::size_t> watched);

  /// Looks at one sample. Allocates nothing.
  void update(std::span<const double> x, double t);

  bool frozen(std::size_t i) const { return frozen_[i] != 0; }    ///< Of the i-th watched input.
  bool any() const;                                               ///< Whether one is frozen.
  double since(std::size_t i) const { return since_[i]; }         ///< When it stopped.
  double value(std::size_t i) const { return last_[i]; }          ///< Where.
  std::size_t input(std::size_t i) const { return watched_[i]; }  ///< Its place.
  std::size_t size() const { return watched_.size(); }            ///< How many are watched.

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  bool others_move(std::size_t i) const;

  std::vector<std::size_t> watched_;
  std::vector<double> last_, since_;
  std::vector<std::size_t> run_, longest_;
  std::vector<char> frozen_;
};

}  // namespace kelpie
