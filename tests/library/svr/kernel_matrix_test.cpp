// SPDX-License-Identifier: Apache-2.0
#include "svr/kernel_matrix.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "kelpie/core/random.hpp"

namespace kelpie::kernel_matrix_test {
namespace {

class KernelMatrixTest : public ::testing::TestWithParam<Storage> {
 protected:
  // Any symmetric function of the samples' labels will do; the diagonal is always in double.
  static double similarity(int a, int b) {
    const double value = a == b ? 1.0 + a + 1e-9 : 1.0 / (1.0 + a + b);
    return GetParam() == Storage::float64 || a == b
               ? value
               : static_cast<double>(static_cast<float>(value));
  }
};

TEST_P(KernelMatrixTest, StaysTheMatrixOfItsSamplesWhileTheyComeAndGo) {
  constexpr std::size_t kCapacity = 20;
  KernelMatrix matrix(kCapacity, GetParam());
  std::vector<int> labels;
  RandomStream random(2, "matrix");
  for (int step = 0; step < 2000; ++step) {
    if (labels.size() < kCapacity && (labels.empty() || random.uniform() < 0.55)) {
      std::vector<double> row;
      row.reserve(labels.size());
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
    std::vector<double> copy(labels.size());
    for (std::size_t i = 0; i < labels.size(); ++i) {
      matrix.row(i, copy);
      ASSERT_EQ(matrix.diagonal()[i], similarity(labels[i], labels[i]));
      for (std::size_t j = 0; j < labels.size(); ++j) {
        ASSERT_EQ(matrix(i, j), similarity(labels[i], labels[j])) << step;
        ASSERT_EQ(copy[j], matrix(i, j));
      }
    }
  }
}

TEST_P(KernelMatrixTest, ProductsAreThoseOfItsElements) {
  KernelMatrix matrix(30, GetParam());
  std::vector<double> v;
  for (int i = 0; i < 27; ++i) {
    std::vector<double> row;
    row.reserve(static_cast<std::size_t>(i));
    for (int j = 0; j < i; ++j) {
      row.push_back(similarity(i, j));
    }
    matrix.add(row, similarity(i, i));
    v.push_back(0.1 * i - 1.0);
  }
  const std::vector<std::size_t> rows{3, 0, 26, 9, 14, 20};
  const std::vector<double> weights{1.0, -0.5, 2.0, 0.3, 1e-3, 4.0};
  std::vector<double> combined(27, 1.0);
  matrix.combine(rows, weights, combined);
  std::vector<double> gathered(rows.size());
  for (std::size_t i = 0; i < 27; ++i) {
    double dot = 0.0;
    for (std::size_t j = 0; j < 27; ++j) {
      dot += matrix(i, j) * v[j];
    }
    EXPECT_NEAR(matrix.dot(i, v), dot, 1e-12);
    double sum = 1.0;
    matrix.gather(i, rows, gathered);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      sum += weights[k] * matrix(rows[k], i);
      EXPECT_EQ(gathered[k], matrix(i, rows[k]));
    }
    EXPECT_NEAR(combined[i], sum, 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Storages, KernelMatrixTest,
                         ::testing::Values(Storage::float64, Storage::float32),
                         [](const auto& storage) {
                           return storage.param == Storage::float64 ? "Double" : "Float";
                         });

}  // namespace
}  // namespace kelpie::kernel_matrix_test
