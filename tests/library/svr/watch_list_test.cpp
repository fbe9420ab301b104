// SPDX-License-Identifier: Apache-2.0
#include "svr/watch_list.hpp"

#include <gtest/gtest.h>

#include <array>

namespace kelpie::watch_list_test {
namespace {

TEST(WatchList, ACopyOfAnEmptyListTakesWhatWasSaved) {
  KernelMatrix kernel(4);
  kernel.add({}, 1.0);
  kernel.add(std::array{0.5}, 1.0);
  kernel.add(std::array{0.3, 0.2}, 1.0);
  WatchList list(2, 4);
  list.watch(kernel, 1);
  list.add_mover(kernel, 0);
  list.add_mover(kernel, 2);
  Archive archive;
  list.visit(archive, kernel);

  const WatchList fresh(2, 4);
  WatchList copy = fresh;
  Archive from(archive.bytes());
  copy.visit(from, kernel);
  from.finish();
  std::array<double, 1> products{};
  copy.products(std::array{1.0, 0.0, 10.0}, products);
  EXPECT_DOUBLE_EQ(products[0], 0.5 + 2.0);
}

}  // namespace
}  // namespace kelpie::watch_list_test
