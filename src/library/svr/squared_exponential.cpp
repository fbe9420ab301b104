// SPDX-License-Identifier: Apache-2.0
#include "svr/squared_exponential.hpp"

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <numeric>

// Highway compiles what follows once for every kind of processor.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "svr/squared_exponential.cpp"  // NOLINT: for foreach_target.h
#include "hwy/foreach_target.h"
// after foreach_target.h
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace kelpie::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Wide = hn::ScalableTag<double>;

using Vec = hn::Vec<Wide>;

// 2^u for u <= 0, 0 where it would be subnormal. 2^u = 2^k 2^f with k = round(u), |f| <= ½, and 2^f
// by the polynomial through its values at the twelve Chebyshev nodes (off by 5e-18 at most).
HWY_INLINE Vec power_of_two(Wide d, Vec u) {
  const auto least = hn::Set(d, -1021.0);
  const Vec bounded = hn::Max(u, least);
  const Vec k = hn::Round(bounded);
  const Vec f = hn::Sub(bounded, k);
  const auto pair = [&](double constant, double linear) HWY_ATTR {
    return hn::MulAdd(hn::Set(d, linear), f, hn::Set(d, constant));
  };
  const Vec f2 = hn::Mul(f, f);
  const Vec f4 = hn::Mul(f2, f2);
  const Vec low = hn::MulAdd(pair(0.24022650695910158, 0.055504108664821625), f2,
                             pair(1.0, 0.6931471805599453));
  const Vec middle = hn::MulAdd(pair(0.00015403530463724353, 1.5252733841556773e-05), f2,
                                pair(0.009618129107587256, 0.001333355814640647));
  const Vec high = hn::MulAdd(pair(7.074194297288521e-09, 4.4558179083360645e-10), f2,
                              pair(1.3215432535912375e-06, 1.0178057087733941e-07));
  const Vec fraction = hn::MulAdd(hn::MulAdd(high, f4, middle), f4, low);
  // k + 1.5 · 2^52 has k in its last bits, from where it is shifted into the exponent.
  const hn::RebindToSigned<Wide> di;
  const auto shifted = hn::BitCast(di, hn::Add(k, hn::Set(d, 6755399441055744.0)));
  const auto exponent = hn::ShiftLeft<52>(shifted);
  const Vec power = hn::BitCast(d, hn::Add(hn::BitCast(di, fraction), exponent));
  return hn::IfThenZeroElse(hn::Lt(u, least), power);
}

// κ of whole vectors of samples, the first at `x`: four at a time, so that no operation waits for
// the one before.
struct Similarity {
  double gamma_log2e;
  const double* z;
  std::size_t dimension;
  std::size_t stride;

  HWY_INLINE Vec one(Wide d, const double* x) const {
    auto sum = hn::Zero(d);
    for (std::size_t k = 0; k < dimension; ++k) {
      const Vec difference = hn::Sub(hn::LoadU(d, x + k * stride), hn::Set(d, z[k]));
      sum = hn::MulAdd(difference, difference, sum);
    }
    return power_of_two(d, hn::Mul(hn::Set(d, -gamma_log2e), sum));
  }

  template <typename Use>
  HWY_INLINE void four(Wide d, const double* x, const Use& use) const {
    const std::size_t lanes = hn::Lanes(d);
    auto sum0 = hn::Zero(d);
    auto sum1 = hn::Zero(d);
    auto sum2 = hn::Zero(d);
    auto sum3 = hn::Zero(d);
    for (std::size_t k = 0; k < dimension; ++k) {
      const double* const from = x + k * stride;
      const Vec here = hn::Set(d, z[k]);
      const Vec difference0 = hn::Sub(hn::LoadU(d, from), here);
      const Vec difference1 = hn::Sub(hn::LoadU(d, from + lanes), here);
      const Vec difference2 = hn::Sub(hn::LoadU(d, from + 2 * lanes), here);
      const Vec difference3 = hn::Sub(hn::LoadU(d, from + 3 * lanes), here);
      sum0 = hn::MulAdd(difference0, difference0, sum0);
      sum1 = hn::MulAdd(difference1, difference1, sum1);
      sum2 = hn::MulAdd(difference2, difference2, sum2);
      sum3 = hn::MulAdd(difference3, difference3, sum3);
    }
    const Vec factor = hn::Set(d, -gamma_log2e);
    use(power_of_two(d, hn::Mul(factor, sum0)), power_of_two(d, hn::Mul(factor, sum1)),
        power_of_two(d, hn::Mul(factor, sum2)), power_of_two(d, hn::Mul(factor, sum3)));
  }
};

// Both require that whole vectors can be read from `x`: SampleStore pads its coordinates.
void row_of(double gamma_log2e, std::span<const double> z, std::size_t stride, const double* x,
            double* out, std::size_t n) {
  const Similarity similarity{gamma_log2e, z.data(), z.size(), stride};
  const Wide d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + 4 * lanes <= n; i += 4 * lanes) {
    similarity.four(d, x + i, [&](Vec k0, Vec k1, Vec k2, Vec k3) HWY_ATTR {
      hn::StoreU(k0, d, out + i);
      hn::StoreU(k1, d, out + i + lanes);
      hn::StoreU(k2, d, out + i + 2 * lanes);
      hn::StoreU(k3, d, out + i + 3 * lanes);
    });
  }
  for (; i + lanes <= n; i += lanes) {
    hn::StoreU(similarity.one(d, x + i), d, out + i);
  }
  if (i < n) {
    HWY_ALIGN double last[hn::MaxLanes(d)];  // NOLINT: a vector's worth
    hn::Store(similarity.one(d, x + i), d, last);
    std::copy_n(last, n - i, out + i);
  }
}

double expansion_of(double gamma_log2e, std::span<const double> z, std::size_t stride,
                    const double* x, const double* weights, std::size_t n) {
  const Similarity similarity{gamma_log2e, z.data(), z.size(), stride};
  const Wide d;
  const std::size_t lanes = hn::Lanes(d);
  auto even = hn::Zero(d);
  auto odd = hn::Zero(d);
  std::size_t i = 0;
  for (; i + 4 * lanes <= n; i += 4 * lanes) {
    similarity.four(d, x + i, [&](Vec k0, Vec k1, Vec k2, Vec k3) HWY_ATTR {
      even = hn::MulAdd(k0, hn::LoadU(d, weights + i), even);
      odd = hn::MulAdd(k1, hn::LoadU(d, weights + i + lanes), odd);
      even = hn::MulAdd(k2, hn::LoadU(d, weights + i + 2 * lanes), even);
      odd = hn::MulAdd(k3, hn::LoadU(d, weights + i + 3 * lanes), odd);
    });
  }
  for (; i + lanes <= n; i += lanes) {
    even = hn::MulAdd(similarity.one(d, x + i), hn::LoadU(d, weights + i), even);
  }
  double total = hn::GetLane(hn::SumOfLanes(d, hn::Add(even, odd)));
  if (i < n) {
    HWY_ALIGN double last[hn::MaxLanes(d)];  // NOLINT: a vector's worth
    hn::Store(similarity.one(d, x + i), d, last);
    total = std::inner_product(last, last + (n - i), weights + i, total);
  }
  return total;
}

// An expansion's gradient on its way; its value goes along. (A vector of SVE can't be a member.)
struct GradientSum {
  const Similarity& similarity;
  double s;
  double fine;
  HWY_ALIGN double slopes[SquaredExponential::kMostDimensions * hn::MaxLanes(Wide())];  // NOLINT

  // Adds one vector of κ to the value. Returns the factor of the differences in the gradient:
  // ∂(s κ + fine κ^32)/∂z = (s κ + 32 fine κ^32) 2γ (x − z).
  HWY_INLINE Vec weigh(Wide d, Vec kappa, Vec weight, Vec& value) const {
    Vec power = hn::Mul(kappa, kappa);
    for (int doubling = 1; doubling < 5; ++doubling) {
      power = hn::Mul(power, power);
    }
    const Vec coarse = hn::Mul(hn::Set(d, s), kappa);
    const Vec narrow = hn::Mul(hn::Set(d, fine), power);
    value = hn::MulAdd(weight, hn::Add(coarse, narrow), value);
    return hn::Mul(weight, hn::MulAdd(hn::Set(d, 32.0), narrow, coarse));
  }

  HWY_INLINE void add_one(Wide d, const double* x, Vec weight, Vec& value) {
    const std::size_t lanes = hn::Lanes(d);
    const Vec factor = weigh(d, similarity.one(d, x), weight, value);
    for (std::size_t k = 0; k < similarity.dimension; ++k) {
      const Vec here = hn::Set(d, similarity.z[k]);
      const Vec difference = hn::Sub(hn::LoadU(d, x + k * similarity.stride), here);
      double* const slope = slopes + k * lanes;
      hn::Store(hn::MulAdd(difference, factor, hn::Load(d, slope)), d, slope);
    }
  }

  HWY_INLINE void add_four(Wide d, const double* x, const double* weights, Vec& value) {
    const std::size_t lanes = hn::Lanes(d);
    similarity.four(d, x, [&](Vec k0, Vec k1, Vec k2, Vec k3) HWY_ATTR {
      const Vec factor0 = weigh(d, k0, hn::LoadU(d, weights), value);
      const Vec factor1 = weigh(d, k1, hn::LoadU(d, weights + lanes), value);
      const Vec factor2 = weigh(d, k2, hn::LoadU(d, weights + 2 * lanes), value);
      const Vec factor3 = weigh(d, k3, hn::LoadU(d, weights + 3 * lanes), value);
      for (std::size_t k = 0; k < similarity.dimension; ++k) {
        const double* const from = x + k * similarity.stride;
        const Vec here = hn::Set(d, similarity.z[k]);
        double* const slope = slopes + k * lanes;
        Vec even = hn::Load(d, slope);
        even = hn::MulAdd(hn::Sub(hn::LoadU(d, from), here), factor0, even);
        Vec odd = hn::Mul(hn::Sub(hn::LoadU(d, from + lanes), here), factor1);
        even = hn::MulAdd(hn::Sub(hn::LoadU(d, from + 2 * lanes), here), factor2, even);
        odd = hn::MulAdd(hn::Sub(hn::LoadU(d, from + 3 * lanes), here), factor3, odd);
        hn::Store(hn::Add(even, odd), d, slope);
      }
    });
  }
};

double gradient_of(double gamma_log2e, std::span<const double> z, std::size_t stride,
                   const double* x, std::span<const double> weights, double s, double fine,
                   double* gradient) {
  const Wide d;
  const std::size_t lanes = hn::Lanes(d);
  const std::size_t n = weights.size();
  const Similarity similarity{gamma_log2e, z.data(), z.size(), stride};
  GradientSum sum{similarity, s, fine, {}};
  auto value = hn::Zero(d);
  std::size_t i = 0;
  for (; i + 4 * lanes <= n; i += 4 * lanes) {
    sum.add_four(d, x + i, weights.data() + i, value);
  }
  for (; i < n; i += lanes) {
    HWY_ALIGN double last[hn::MaxLanes(d)] = {};  // NOLINT: a vector's worth
    std::copy_n(weights.data() + i, std::min(lanes, n - i), last);
    sum.add_one(d, x + i, hn::Load(d, last), value);
  }
  const double two_gamma = 2.0 * gamma_log2e / std::numbers::log2e;
  for (std::size_t k = 0; k < z.size(); ++k) {
    const Vec slope = hn::Load(d, sum.slopes + k * lanes);
    gradient[k] = two_gamma * hn::GetLane(hn::SumOfLanes(d, slope));
  }
  return hn::GetLane(hn::SumOfLanes(d, value));
}

}  // namespace
}  // namespace kelpie::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kelpie {

HWY_EXPORT(row_of);
HWY_EXPORT(expansion_of);
HWY_EXPORT(gradient_of);

void SquaredExponential::row(std::span<const double> z, const SampleStore& samples,
                             std::size_t first, std::span<double> out) const {
  HWY_DYNAMIC_DISPATCH(row_of)
  (gamma_ * std::numbers::log2e, z, samples.stride(), samples.data() + first, out.data(),
   out.size());
}

double SquaredExponential::expansion(std::span<const double> z, const SampleStore& samples,
                                     std::span<const double> weights) const {
  return HWY_DYNAMIC_DISPATCH(expansion_of)(gamma_ * std::numbers::log2e, z, samples.stride(),
                                            samples.data(), weights.data(), samples.size());
}

double SquaredExponential::expansion_with_gradient(std::span<const double> z,
                                                   const SampleStore& samples,
                                                   std::span<const double> weights, double s,
                                                   double fine, std::span<double> gradient) const {
  return HWY_DYNAMIC_DISPATCH(gradient_of)(gamma_ * std::numbers::log2e, z, samples.stride(),
                                           samples.data(), weights.first(samples.size()), s, fine,
                                           gradient.data());
}

}  // namespace kelpie
#endif
