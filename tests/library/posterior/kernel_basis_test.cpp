// SPDX-License-Identifier: Apache-2.0
#include "posterior/kernel_basis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "core/vector.hpp"
#include "kelpie/core/random.hpp"
#include "saved_state.hpp"

namespace kelpie::kernel_basis_test {
namespace {

constexpr double kGamma = 0.2;
constexpr std::size_t kInputs = 3;

using Point = std::vector<double>;

Point point(RandomStream& random) {
  Point z(kInputs);
  for (double& one : z) {
    one = random.normal();
  }
  return z;
}

double kernel(const Point& a, const Point& b) {
  double square = 0.0;
  for (std::size_t i = 0; i < kInputs; ++i) {
    square += (a[i] - b[i]) * (a[i] - b[i]);
  }
  return std::exp(-kGamma * square);
}

// A basis with centres at the novel ones of 200 points.
KernelBasis basis_of(std::uint64_t seed, std::size_t capacity = 40) {
  KernelBasis basis(kGamma, kInputs, capacity);
  RandomStream random(seed, "centres");
  std::vector<double> values(capacity);
  for (int i = 0; i < 200 && basis.size() < capacity; ++i) {
    const Point z = point(random);
    const std::span<double> known = std::span(values).first(basis.size());
    if (const double novelty = basis.evaluate(z, known); novelty > 0.05) {
      basis.add(z, known, novelty);
    }
  }
  return basis;
}

std::vector<double> values_at(const KernelBasis& basis, const Point& z) {
  std::vector<double> values(basis.size());
  basis.evaluate(z, values);
  return values;
}

Point centre(const KernelBasis& basis, std::size_t i) {
  Point z(kInputs);
  basis.centres().get(i, z);
  return z;
}

// v(z) · v(c) = κ(z, c) wherever c is a centre: the functions span the kernel at the centres.
TEST(KernelBasis, ReproducesTheKernelAtItsCentres) {
  const KernelBasis basis = basis_of(1);
  ASSERT_GT(basis.size(), 20U);
  RandomStream random(2, "places");
  for (int k = 0; k < 20; ++k) {
    const Point z = point(random);
    const std::vector<double> at = values_at(basis, z);
    for (std::size_t i = 0; i < basis.size(); ++i) {
      const Point c = centre(basis, i);
      EXPECT_NEAR(dot(at, values_at(basis, c)), kernel(z, c), 1e-9);
    }
  }
}

TEST(KernelBasis, AFunctionIsZeroAtEarlierCentres) {
  const KernelBasis basis = basis_of(1);
  for (std::size_t i = 0; i < basis.size(); ++i) {
    const std::vector<double> at = values_at(basis, centre(basis, i));
    for (std::size_t later = i + 1; later < basis.size(); ++later) {
      EXPECT_NEAR(at[later], 0.0, 1e-9);
    }
  }
}

TEST(KernelBasis, NoveltyIsZeroAtACentreAndOneFarAway) {
  const KernelBasis basis = basis_of(3);
  std::vector<double> values(basis.size());
  EXPECT_NEAR(basis.evaluate(centre(basis, 4), values), 0.0, 1e-9);
  EXPECT_NEAR(basis.evaluate(Point(kInputs, 100.0), values), 1.0, 1e-12);
}

TEST(KernelBasis, WeightsOfItsFunctionsAreWeightsOfTheKernel) {
  const KernelBasis basis = basis_of(4);
  RandomStream random(5, "weights");
  std::vector<double> weights(basis.size());
  for (double& one : weights) {
    one = random.normal();
  }
  std::vector<double> beta = weights;
  basis.to_kernel(beta);
  const Point z = point(random);
  double expansion = 0.0;
  for (std::size_t i = 0; i < basis.size(); ++i) {
    expansion += beta[i] * kernel(z, centre(basis, i));
  }
  EXPECT_NEAR(expansion, dot(weights, values_at(basis, z)), 1e-9);
}

// Centres keep their places in the log, z' = z ratio + shift; those that are alike in the new units
// leave. The new functions are v' = Tᵀ v at the old centres.
TEST(KernelBasis, ExpressesItsFunctionsInOtherUnitsByTheOldOnes) {
  const KernelBasis old = basis_of(6);
  const std::vector<double> ratio{0.5, 0.7, 0.9};
  const std::vector<double> shift{0.1, 0.0, -0.3};
  KernelBasis moved = old;
  const Matrix t = moved.move(ratio, shift, 0.01);
  ASSERT_EQ(t.rows(), old.size());
  ASSERT_EQ(t.columns(), moved.size());
  EXPECT_LT(moved.size(), old.size());
  for (std::size_t i = 0; i < old.size(); ++i) {
    const Point c = centre(old, i);
    Point there(kInputs);
    for (std::size_t k = 0; k < kInputs; ++k) {
      there[k] = c[k] * ratio[k] + shift[k];
    }
    const std::vector<double> before = values_at(old, c);
    const std::vector<double> after = values_at(moved, there);
    for (std::size_t j = 0; j < moved.size(); ++j) {
      double sum = 0.0;
      for (std::size_t row = 0; row < old.size(); ++row) {
        sum += t(row, j) * before[row];
      }
      EXPECT_NEAR(sum, after[j], 1e-8);
    }
  }
}

TEST(KernelBasis, SavesItsState) {
  KernelBasis basis = basis_of(7);
  KernelBasis loaded(kGamma, kInputs, 40);
  testing::load(loaded, testing::saved(basis));
  EXPECT_EQ(testing::saved(loaded), testing::saved(basis));
  EXPECT_EQ(values_at(loaded, Point(kInputs, 0.3)), values_at(basis, Point(kInputs, 0.3)));
}

}  // namespace
}  // namespace kelpie::kernel_basis_test
