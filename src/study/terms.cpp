// SPDX-License-Identifier: Apache-2.0
#include "study/terms.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

namespace kelpie::study {
namespace {

double at_or_nan(const std::vector<double>& values, std::size_t term) {
  return term < values.size() ? values[term] : kUnknown;
}

double mean_effect(const TermView& view) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const double value : view.values) {
    if (std::isfinite(value)) {
      sum += std::abs(value * view.term.rms);
      ++count;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

}  // namespace

std::vector<TermView> term_views(const AxisResult& axis) {
  const std::vector<ValidationPoint>& points = axis.validation;
  std::vector<TermView> views;
  for (std::size_t k = 0; k < axis.terms.size(); ++k) {
    TermView view{axis.terms[k], kUnknown, kUnknown, kUnknown, {}, {}};
    for (const ValidationPoint& point : points) {
      view.value = at_or_nan(point.coefficients, k);
      if (2 * point.samples <= points.back().samples) {
        view.at_half = view.value;
      }
      view.values.push_back(view.value);
      view.errors.push_back(at_or_nan(point.errors, k));
    }
    view.effect = view.value * view.term.rms;
    views.push_back(std::move(view));
  }
  return views;
}

std::vector<TermView> most_effective(const std::vector<TermView>& views, std::size_t most) {
  std::vector<std::size_t> places(views.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::ranges::stable_sort(places, std::greater<>{},
                           [&](std::size_t k) { return mean_effect(views[k]); });
  places.resize(std::min(most, places.size()));
  std::ranges::sort(places);
  std::vector<TermView> chosen;
  chosen.reserve(places.size());
  for (const std::size_t k : places) {
    chosen.push_back(views[k]);
  }
  return chosen;
}

}  // namespace kelpie::study
