// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <string_view>
#include <utility>

namespace kelpie {

/// A seeded stream of random numbers, equal on every machine and standard library; normal() to the
/// rounding of the machine's logarithm, sine and cosine. Streams of one seed with different names
/// are independent: more numbers of "noise" leave "commands" unchanged.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);  ///< A stream by seed and name.

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
