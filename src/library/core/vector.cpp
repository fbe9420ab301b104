// SPDX-License-Identifier: Apache-2.0
#include "core/vector.hpp"

#include <cstddef>

// Highway compiles what follows once for every kind of processor.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/vector.cpp"  // NOLINT: what foreach_target.h includes
#include "hwy/foreach_target.h"
// after foreach_target.h
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace kelpie::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Wide = hn::ScalableTag<double>;

// Numbers as a vector of doubles, whatever they are stored as.
HWY_INLINE hn::Vec<Wide> load(Wide d, const double* from) {
  return hn::LoadU(d, from);
}
HWY_INLINE hn::Vec<Wide> load(Wide d, const float* from) {
  return hn::PromoteTo(d, hn::LoadU(hn::Rebind<float, Wide>(), from));
}

template <typename T>
double dot_of(const T* a, const double* b, std::size_t n) {
  const Wide d;
  const std::size_t lanes = hn::Lanes(d);
  auto sum0 = hn::Zero(d);
  auto sum1 = hn::Zero(d);
  auto sum2 = hn::Zero(d);
  auto sum3 = hn::Zero(d);
  std::size_t i = 0;
  for (; i + 4 * lanes <= n; i += 4 * lanes) {
    sum0 = hn::MulAdd(load(d, a + i), hn::LoadU(d, b + i), sum0);
    sum1 = hn::MulAdd(load(d, a + i + lanes), hn::LoadU(d, b + i + lanes), sum1);
    sum2 = hn::MulAdd(load(d, a + i + 2 * lanes), hn::LoadU(d, b + i + 2 * lanes), sum2);
    sum3 = hn::MulAdd(load(d, a + i + 3 * lanes), hn::LoadU(d, b + i + 3 * lanes), sum3);
  }
  for (; i + lanes <= n; i += lanes) {
    sum0 = hn::MulAdd(load(d, a + i), hn::LoadU(d, b + i), sum0);
  }
  const auto all = hn::Add(hn::Add(sum0, sum1), hn::Add(sum2, sum3));
  double sum = hn::GetLane(hn::SumOfLanes(d, all));
  for (; i < n; ++i) {
    sum += static_cast<double>(a[i]) * b[i];
  }
  return sum;
}

template <typename T>
void add_scaled_of(double factor, const T* x, double* y, std::size_t n) {
  const Wide d;
  const std::size_t lanes = hn::Lanes(d);
  const auto f = hn::Set(d, factor);
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) {
    hn::StoreU(hn::MulAdd(f, load(d, x + i), hn::LoadU(d, y + i)), d, y + i);
  }
  for (; i < n; ++i) {
    y[i] += factor * static_cast<double>(x[i]);
  }
}

template <typename T>
void add_four_of(const double* factors, const Four<T>& x, double* y, std::size_t n) {
  const Wide d;
  const std::size_t lanes = hn::Lanes(d);
  const auto f0 = hn::Set(d, factors[0]);
  const auto f1 = hn::Set(d, factors[1]);
  const auto f2 = hn::Set(d, factors[2]);
  const auto f3 = hn::Set(d, factors[3]);
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) {
    const auto even = hn::MulAdd(f0, load(d, x[0] + i), hn::LoadU(d, y + i));
    const auto odd = hn::Mul(f1, load(d, x[1] + i));
    hn::StoreU(
        hn::Add(hn::MulAdd(f2, load(d, x[2] + i), even), hn::MulAdd(f3, load(d, x[3] + i), odd)), d,
        y + i);
  }
  for (; i < n; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      y[i] += factors[k] * static_cast<double>(x[k][i]);
    }
  }
}

void four_dots(const Four<double>& a, const double* b, std::size_t n, double* out) {
  const Wide d;
  const std::size_t lanes = hn::Lanes(d);
  auto sum0 = hn::Zero(d);
  auto sum1 = hn::Zero(d);
  auto sum2 = hn::Zero(d);
  auto sum3 = hn::Zero(d);
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) {
    const auto shared = hn::LoadU(d, b + i);
    sum0 = hn::MulAdd(hn::LoadU(d, a[0] + i), shared, sum0);
    sum1 = hn::MulAdd(hn::LoadU(d, a[1] + i), shared, sum1);
    sum2 = hn::MulAdd(hn::LoadU(d, a[2] + i), shared, sum2);
    sum3 = hn::MulAdd(hn::LoadU(d, a[3] + i), shared, sum3);
  }
  out[0] = hn::GetLane(hn::SumOfLanes(d, sum0));
  out[1] = hn::GetLane(hn::SumOfLanes(d, sum1));
  out[2] = hn::GetLane(hn::SumOfLanes(d, sum2));
  out[3] = hn::GetLane(hn::SumOfLanes(d, sum3));
  for (; i < n; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      out[k] += a[k][i] * b[i];
    }
  }
}

void rotate_of(double c, double s, double* x, double* y, std::size_t n) {
  const Wide d;
  const std::size_t lanes = hn::Lanes(d);
  const auto cosine = hn::Set(d, c);
  const auto sine = hn::Set(d, s);
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) {
    const auto old_x = hn::LoadU(d, x + i);
    const auto old_y = hn::LoadU(d, y + i);
    hn::StoreU(hn::MulAdd(cosine, old_x, hn::Mul(sine, old_y)), d, x + i);
    hn::StoreU(hn::NegMulAdd(sine, old_x, hn::Mul(cosine, old_y)), d, y + i);
  }
  for (; i < n; ++i) {
    const double old_x = x[i];
    x[i] = c * old_x + s * y[i];
    y[i] = c * y[i] - s * old_x;
  }
}

// What the dispatch tables hold can't be overloaded.
double dot_double(const double* a, const double* b, std::size_t n) {
  return dot_of(a, b, n);
}
double dot_float(const float* a, const double* b, std::size_t n) {
  return dot_of(a, b, n);
}
void add_double(double factor, const double* x, double* y, std::size_t n) {
  add_scaled_of(factor, x, y, n);
}
void add_float(double factor, const float* x, double* y, std::size_t n) {
  add_scaled_of(factor, x, y, n);
}
void add_four_double(const double* factors, const Four<double>& x, double* y, std::size_t n) {
  add_four_of(factors, x, y, n);
}
void add_four_float(const double* factors, const Four<float>& x, double* y, std::size_t n) {
  add_four_of(factors, x, y, n);
}

}  // namespace
}  // namespace kelpie::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kelpie {

HWY_EXPORT(dot_double);
HWY_EXPORT(dot_float);
HWY_EXPORT(add_double);
HWY_EXPORT(add_float);
HWY_EXPORT(add_four_double);
HWY_EXPORT(add_four_float);
HWY_EXPORT(four_dots);
HWY_EXPORT(rotate_of);

double dot(std::span<const double> a, std::span<const double> b) {
  return HWY_DYNAMIC_DISPATCH(dot_double)(a.data(), b.data(), a.size());
}

double dot(std::span<const float> a, std::span<const double> b) {
  return HWY_DYNAMIC_DISPATCH(dot_float)(a.data(), b.data(), a.size());
}

std::array<double, 4> dot(const Four<double>& a, std::span<const double> b) {
  std::array<double, 4> products;  // NOLINT: filled by the call
  HWY_DYNAMIC_DISPATCH(four_dots)(a, b.data(), b.size(), products.data());
  return products;
}

void add_scaled(double factor, std::span<const double> x, std::span<double> y) {
  HWY_DYNAMIC_DISPATCH(add_double)(factor, x.data(), y.data(), y.size());
}

void add_scaled(double factor, std::span<const float> x, std::span<double> y) {
  HWY_DYNAMIC_DISPATCH(add_float)(factor, x.data(), y.data(), y.size());
}

void add_scaled(const std::array<double, 4>& factors, const Four<double>& x, std::span<double> y) {
  HWY_DYNAMIC_DISPATCH(add_four_double)(factors.data(), x, y.data(), y.size());
}

void add_scaled(const std::array<double, 4>& factors, const Four<float>& x, std::span<double> y) {
  HWY_DYNAMIC_DISPATCH(add_four_float)(factors.data(), x, y.data(), y.size());
}

void rotate(double c, double s, std::span<double> x, std::span<double> y) {
  HWY_DYNAMIC_DISPATCH(rotate_of)(c, s, x.data(), y.data(), x.size());
}

}  // namespace kelpie
#endif
