// SPDX-License-Identifier: Apache-2.0
#include "kelpie/kernel/kernel_matrix.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "kelpie/core/random.hpp"

namespace kelpie {
namespace {

// Any symmetric function of the samples' labels will do.
double similarity(int a, int b) {
  return a == b ? 1.0 + a : 1.0 / (1.0 + a + b);
}

TEST(KernelMatrix, StaysTheMatrixOfItsSamplesWhileTheyComeAndGo) {
  constexpr std::size_t kCapacity = 20;
  KernelMatrix matrix(kCapacity);
  std::vector<int> labels;
  RandomStream random(2, "matrix");
  for (int step = 0; step < 2000; ++step) {
    if (labels.size() < kCapacity && (labels.empty() || random.uniform() < 0.55)) {
      std::vector<double> row;
      for (const int label : labels) {
        row.push_back(similarity(label, step));
      }
      matrix.add(row, similarity(step, step));
      labels.push_back(step);
    } else {
      const std::size_t i = random.below(labels.size());
      matrix.remove(i);
      labels[i] = labels.back();
      labels.pop_back();
    }
    ASSERT_EQ(matrix.size(), labels.size());
    for (std::size_t i = 0; i < labels.size(); ++i) {
      ASSERT_EQ(matrix.diagonal()[i], similarity(labels[i], labels[i]));
      for (std::size_t j = 0; j < labels.size(); ++j) {
        ASSERT_EQ(matrix(i, j), similarity(labels[i], labels[j])) << step;
      }
    }
  }
}

}  // namespace
}  // namespace kelpie
