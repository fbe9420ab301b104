// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// Detects frozen signals: while another signal moves, a reading repeats for far longer than ever
/// before. What repeats while nothing else moves is a rest of the vehicle, and no hold.
class Standstill {
 public:
  explicit Standstill(std::vector<std::size_t> watched);  ///< Places of inputs.

  void update(std::span<const double> x, double t);  ///< Processes one sample. Allocates nothing.

  bool frozen(std::size_t i) const { return frozen_[i] != 0; }    ///< State of watched input i.
  bool stopped(std::size_t i) const { return stopped_[i] != 0; }  ///< Frozen since this update.
  bool any() const;                                               ///< Whether an input is frozen.
  double since(std::size_t i) const { return since_[i]; }         ///< Begin of the hold [s].
  double value(std::size_t i) const { return last_[i]; }          ///< The reading.
  std::size_t input(std::size_t i) const { return watched_[i]; }  ///< Place among the inputs.

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  bool others_move(std::size_t i) const;
  void begin_hold(std::size_t i, double t);

  std::vector<std::size_t> watched_;
  std::vector<double> last_, since_;
  std::vector<std::size_t> run_;             // repeats
  std::vector<std::size_t> held_, longest_;  // repeats while another signal moves
  std::vector<char> frozen_;
  std::vector<char> stopped_;  // follows from an update
};

}  // namespace kelpie
