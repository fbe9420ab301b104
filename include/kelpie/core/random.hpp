// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <string_view>
#include <utility>

namespace kelpie {

/// A seeded stream of random numbers that is the same on every machine and standard library.
/// Streams of one seed but different names are independent of each other, so that drawing more
/// from one ("noise") leaves the others ("commands") as they were.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);  ///< Of this seed and name.

  double uniform();                         ///< in [0, 1)
  double uniform(double low, double high);  ///< in [low, high)
  double normal();                          ///< mean 0, variance 1
  std::uint64_t below(std::uint64_t n);     ///< in [0, n), n > 0, without modulo bias

  /// Puts items into a random order (Fisher and Yates).
  template <typename T>
  void shuffle(std::span<T> items) {
    for (std::size_t i = items.size(); i > 1; --i) {
      std::swap(items[i - 1], items[below(i)]);
    }
  }

 private:
  std::mt19937_64 engine_;
  double spare_normal_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace kelpie
