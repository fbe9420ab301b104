// SPDX-License-Identifier: Apache-2.0
#include "svr/outlier_filter.hpp"

#include "core/quantile.hpp"
#include "svr/tuning.hpp"

namespace kelpie {

OutlierFilter::OutlierFilter(const OnlineSvrSettings& settings)
    : rule_(settings.outlier), factor_(settings.outlier_factor) {
  const std::size_t places = settings.places();
  scratch_.reserve(places);
  flagged_.reserve(places);
}

std::size_t OutlierFilter::bytes(const OnlineSvrSettings& settings) {
  return settings.places() * (sizeof(double) + sizeof(std::size_t));
}

std::span<const std::size_t> OutlierFilter::find_outliers(const SampleCollector& buffer,
                                                          double bias) {
  flagged_.clear();
  const DualProblem& problem = buffer.problem();
  const std::span<const double> gradient = problem.gradient();
  double low = 0.0;
  double high = 0.0;
  if (rule_ == OutlierRule::iqr) {
    scratch_.clear();
    for (std::size_t i = 0; i < buffer.size(); ++i) {
      if (!weightless(buffer, i)) {
        scratch_.push_back(bias - gradient[i]);  // eq. (11): f(x) − y
      }
    }
    if (scratch_.size() < kSvr.quartiles_least) {
      return {};
    }
    const double q1 = quantile(scratch_, 0.25);
    const double q3 = quantile(scratch_, 0.75);
    low = q1 - 1.5 * (q3 - q1);  // eq. (12)
    high = q3 + 1.5 * (q3 - q1);
  } else if (rule_ == OutlierRule::robust) {
    high = problem.loss().epsilon + factor_ * scale_.value();
    low = -high;
  } else {
    return {};
  }
  for (std::size_t i = buffer.size(); i-- > 0;) {
    const double residual = bias - gradient[i];
    const bool contradicted =
        rule_ == OutlierRule::iqr ? !weightless(buffer, i) : at_bound(problem, i);
    if (contradicted && (residual < low || residual > high)) {
      flagged_.push_back(i);
    }
  }
  return flagged_;
}

}  // namespace kelpie
