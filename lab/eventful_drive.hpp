// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "kelpie/core/random.hpp"

namespace kelpie::lab {

/// A made-up vehicle with three axes, three commands and some noise, to which things happen at
/// regular times, in turns: it becomes another one of three, or one of its six inputs grows so far
/// that scales are taken anew.
class EventfulDrive {
 public:
  static constexpr std::size_t kInputs = 6;
  static constexpr std::size_t kAxes = 3;

  /// `events` times both, within so many samples. The same for the same seed.
  EventfulDrive(std::size_t samples, std::size_t events, std::uint64_t seed);

  void next();  ///< There is always one more.

  const std::array<double, kInputs>& x() const { return x_; }  ///< of the sample at hand
  const std::array<double, kAxes>& y() const { return y_; }    ///< accelerations

 private:
  void happen(std::size_t event);

  RandomStream random_;
  std::size_t every_;
  std::size_t most_events_;
  std::size_t sample_ = 0;
  int vehicle_ = 0;
  std::array<double, kInputs> phase_{};
  std::array<double, kInputs> size_{};
  std::array<double, kInputs> x_{};
  std::array<double, kAxes> y_{};
};

}  // namespace kelpie::lab
