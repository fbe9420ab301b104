// SPDX-License-Identifier: Apache-2.0
#include "svr/sample_store.hpp"

#include <gtest/gtest.h>

#include <array>

namespace kelpie::sample_store_test {
namespace {

TEST(SampleStore, TheLastSampleTakesTheNumberOfTheOneRemoved) {
  SampleStore store(2, 3);
  for (const double value : {1.0, 2.0, 3.0}) {
    store.push_back(std::array{value, 10.0 * value});
  }
  store.remove(0);
  ASSERT_EQ(store.size(), 2U);
  std::array<double, 2> x{};
  store.get(0, x);
  EXPECT_EQ(x, (std::array{3.0, 30.0}));
  store.get(1, x);
  EXPECT_EQ(x, (std::array{2.0, 20.0}));
  store.remove(1);  // the last itself
  EXPECT_EQ(store.size(), 1U);
  EXPECT_EQ(store.coordinate(1)[0], 30.0);
}

}  // namespace
}  // namespace kelpie::sample_store_test
