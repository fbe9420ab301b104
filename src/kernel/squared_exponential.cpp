// SPDX-License-Identifier: Apache-2.0
#include "kelpie/kernel/squared_exponential.hpp"

#include <cstddef>

// Highway compiles what follows once for every kind of processor.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/squared_exponential.cpp"  // NOLINT: for foreach_target.h
#include "hwy/foreach_target.h"
// after foreach_target.h
#include "hwy/contrib/math/math-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace kelpie {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Wide = hn::ScalableTag<double>;

// exp(−γ d²) for a vector's worth of samples, the first of which is at `x`.
HWY_INLINE hn::Vec<Wide> similarity(Wide d, hn::Vec<Wide> minus_gamma, const double* z,
                                    const double* x, std::size_t dimension, std::size_t stride) {
  auto sum = hn::Zero(d);
  for (std::size_t k = 0; k < dimension; ++k) {
    const auto difference = hn::Sub(hn::LoadU(d, x + k * stride), hn::Set(d, z[k]));
    sum = hn::MulAdd(difference, difference, sum);
  }
  const auto exponent = hn::Mul(minus_gamma, sum);
  // Highway's exp is meant for [−708, 709].
  const auto least = hn::Set(d, -708.0);
  return hn::IfThenZeroElse(hn::Lt(exponent, least), hn::Exp(d, hn::Max(exponent, least)));
}

// Requires that whole vectors can be read from `x`: SampleStore pads its coordinates.
void row_of(double gamma, const double* z, const double* x, std::size_t dimension,
            std::size_t stride, double* out, std::size_t n) {
  const Wide d;
  const std::size_t lanes = hn::Lanes(d);
  const auto minus_gamma = hn::Set(d, -gamma);
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) {
    hn::StoreU(similarity(d, minus_gamma, z, x + i, dimension, stride), d, out + i);
  }
  if (i < n) {
    HWY_ALIGN double last[hn::MaxLanes(d)];  // NOLINT: a vector's worth
    hn::Store(similarity(d, minus_gamma, z, x + i, dimension, stride), d, last);
    for (std::size_t k = 0; i + k < n; ++k) {
      out[i + k] = last[k];
    }
  }
}

double expansion_of(double gamma, const double* z, const double* x, std::size_t dimension,
                    std::size_t stride, const double* weights, std::size_t n) {
  const Wide d;
  const std::size_t lanes = hn::Lanes(d);
  const auto minus_gamma = hn::Set(d, -gamma);
  auto sum = hn::Zero(d);
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) {
    sum = hn::MulAdd(similarity(d, minus_gamma, z, x + i, dimension, stride),
                     hn::LoadU(d, weights + i), sum);
  }
  double total = hn::GetLane(hn::SumOfLanes(d, sum));
  if (i < n) {
    HWY_ALIGN double last[hn::MaxLanes(d)];  // NOLINT: a vector's worth
    hn::Store(similarity(d, minus_gamma, z, x + i, dimension, stride), d, last);
    for (std::size_t k = 0; i + k < n; ++k) {
      total += last[k] * weights[i + k];
    }
  }
  return total;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace kelpie
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kelpie {

HWY_EXPORT(row_of);
HWY_EXPORT(expansion_of);

void SquaredExponential::row(std::span<const double> z, const SampleStore& samples,
                             std::size_t first, std::span<double> out) const {
  HWY_DYNAMIC_DISPATCH(row_of)
  (gamma_, z.data(), samples.data() + first, z.size(), samples.stride(), out.data(), out.size());
}

double SquaredExponential::expansion(std::span<const double> z, const SampleStore& samples,
                                     std::span<const double> weights) const {
  return HWY_DYNAMIC_DISPATCH(expansion_of)(gamma_, z.data(), samples.data(), z.size(),
                                            samples.stride(), weights.data(), samples.size());
}

}  // namespace kelpie
#endif
