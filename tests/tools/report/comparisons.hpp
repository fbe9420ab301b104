// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "report/synthetic.hpp"
#include "study/comparison.hpp"

namespace kelpie::synthetic {

/// R² on held-out rows.
struct Finals {
  double kelpie = 0.0;
  double variant = 0.0;
  double fit = 0.0;
};

/// kelpie, terms=none, least squares, mean (R² 0) and last value, the same on every axis.
inline study::Comparison comparison(const Finals& finals, std::size_t axes = 1) {
  study::Comparison comparison;
  const auto add = [&](study::ContenderKind kind, const char* name, double r2) {
    study::Contest contest{kind, name, stream(axes, 400)};
    for (study::AxisResult& axis : contest.stream.axes) {
      axis.r2_final = axis.r2_mean = r2;
    }
    comparison.contests.push_back(contest);
  };
  add(study::ContenderKind::kelpie, "kelpie", finals.kelpie);
  add(study::ContenderKind::variant, "terms=none", finals.variant);
  add(study::ContenderKind::least_squares, "least squares", finals.fit);
  add(study::ContenderKind::mean, "mean", 0.0);
  add(study::ContenderKind::last_value, "last value", kNan);
  comparison.one_step_samples.assign(axes, 300);
  return comparison;
}

}  // namespace kelpie::synthetic
