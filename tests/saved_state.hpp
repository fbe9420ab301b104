// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <string_view>

#include "kelpie/core/archive.hpp"

namespace kelpie::testing {

/// The saved state of an object with visit().
template <typename Object>
std::string saved(Object& object) {
  Archive archive;
  object.visit(archive);
  return archive.bytes();
}

/// Loads a whole state into an object that was just made.
template <typename Object>
void load(Object& object, std::string_view bytes) {
  Archive archive(bytes);
  object.visit(archive);
  archive.finish();
}

/// `show(object, i)` shows row i of `rows` to an object, and to another object that goes on as a
/// new object with the saved state wherever `stops(i)`. Both have the same state at every stop and
/// in the end. Returns the object that never stopped.
template <typename Make, typename Show, typename Stops>
auto expect_same_life(const Make& make, std::size_t rows, const Stops& stops, const Show& show) {
  auto whole = make();
  auto parts = make();
  for (std::size_t i = 0; i < rows && !::testing::Test::HasFailure(); ++i) {
    if (stops(i)) {
      const std::string bytes = saved(parts);
      EXPECT_EQ(bytes, saved(whole)) << "row " << i;
      parts = make();
      load(parts, bytes);
      EXPECT_EQ(saved(parts), bytes) << "row " << i;
    }
    show(whole, i);
    show(parts, i);
  }
  EXPECT_EQ(saved(parts), saved(whole));
  return whole;
}

}  // namespace kelpie::testing
