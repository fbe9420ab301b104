// SPDX-License-Identifier: Apache-2.0
#include "core/vector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "kelpie/core/random.hpp"

namespace kelpie::vector_test {
namespace {

constexpr std::size_t kLongest = 70;
constexpr std::size_t kMargin = 9;  // untouched numbers on both sides, and a start off alignment
constexpr double kUntouched = 77.0;

template <typename T = double>
std::vector<T> random_numbers(RandomStream& random) {
  std::vector<T> numbers(kLongest + 2 * kMargin);
  for (T& number : numbers) {
    number = static_cast<T>(random.normal());
  }
  return numbers;
}

// Every length, and starts that no vector is aligned to.
template <typename Check>
void for_all_lengths(const Check& check) {
  for (std::size_t n = 0; n <= kLongest; ++n) {
    for (const std::size_t start : {std::size_t{1}, kMargin}) {
      SCOPED_TRACE(::testing::Message() << "length " << n << " from " << start);
      check(n, start);
    }
  }
}

template <typename T>
void expect_dot() {
  RandomStream random(1, "dot");
  const std::vector<T> a = random_numbers<T>(random);
  const std::vector<double> b = random_numbers(random);
  for_all_lengths([&](std::size_t n, std::size_t start) {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      sum += static_cast<double>(a[start + i]) * b[i];
    }
    EXPECT_NEAR(dot(std::span(a).subspan(start, n), std::span(b).first(n)), sum, 1e-13);
  });
}

TEST(Vector, DotIsTheSumOfProducts) {
  expect_dot<double>();
  expect_dot<float>();
}

template <typename T>
void expect_add_scaled() {
  RandomStream random(2, "add");
  const std::vector<T> x0 = random_numbers<T>(random);
  const std::vector<T> x1 = random_numbers<T>(random);
  const std::vector<T> x2 = random_numbers<T>(random);
  const std::vector<T> x3 = random_numbers<T>(random);
  for_all_lengths([&](std::size_t n, std::size_t start) {
    std::vector<double> one(kLongest + 2 * kMargin, kUntouched);
    std::vector<double> four = one;
    add_scaled(0.3, std::span(x0).first(n), std::span(one).subspan(start, n));
    add_scaled({0.3, -2.0, 1.5, 0.7}, Four<T>{x0.data(), x1.data(), x2.data(), x3.data()},
               std::span(four).subspan(start, n));
    for (std::size_t i = 0; i < one.size(); ++i) {
      const bool inside = i >= start && i < start + n;
      const std::size_t k = inside ? i - start : 0;
      EXPECT_NEAR(one[i], inside ? kUntouched + 0.3 * x0[k] : kUntouched, 1e-13);
      EXPECT_NEAR(
          four[i],
          inside ? kUntouched + 0.3 * x0[k] - 2.0 * x1[k] + 1.5 * x2[k] + 0.7 * x3[k] : kUntouched,
          1e-13);
    }
  });
}

TEST(Vector, AddScaledAddsThereAndNowhereElse) {
  expect_add_scaled<double>();
  expect_add_scaled<float>();
}

TEST(Vector, FourDotsAreThoseOfEach) {
  RandomStream random(3, "four");
  const std::vector<double> a = random_numbers(random);
  const std::vector<double> b = random_numbers(random);
  for_all_lengths([&](std::size_t n, std::size_t start) {
    const std::span<const double> shared = std::span(b).subspan(start, n);
    const auto four = dot(Four<double>{a.data(), a.data() + 1, a.data() + 2, a.data() + 3}, shared);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(four[k], dot(std::span(a).subspan(k, n), shared), 1e-13);
    }
  });
}

TEST(Vector, RotationKeepsLengthsAndTurnsBack) {
  RandomStream random(4, "rotate");
  const double c = std::cos(0.4);
  const double s = std::sin(0.4);
  for_all_lengths([&](std::size_t n, std::size_t start) {
    const std::vector<double> x = random_numbers(random);
    const std::vector<double> y = random_numbers(random);
    std::vector<double> turned_x = x;
    std::vector<double> turned_y = y;
    rotate(c, s, std::span(turned_x).subspan(start, n), std::span(turned_y).subspan(start, n));
    for (std::size_t i = 0; i < x.size(); ++i) {
      const bool inside = i >= start && i < start + n;
      EXPECT_NEAR(turned_x[i], inside ? c * x[i] + s * y[i] : x[i], 1e-14);
      EXPECT_NEAR(turned_y[i], inside ? c * y[i] - s * x[i] : y[i], 1e-14);
    }
    rotate(c, -s, std::span(turned_x).subspan(start, n), std::span(turned_y).subspan(start, n));
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_NEAR(turned_x[i], x[i], 1e-14);
      EXPECT_NEAR(turned_y[i], y[i], 1e-14);
    }
  });
}

}  // namespace
}  // namespace kelpie::vector_test
