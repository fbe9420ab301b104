// SPDX-License-Identifier: Apache-2.0
#include "kelpie/motion/term_set.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "core/eigen.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "motion/motion_terms.hpp"
#include "motion/states.hpp"

namespace kelpie {
namespace {

constexpr std::size_t kSixDegrees = 6;

[[noreturn]] void reject_terms(const std::string& what) {
  throw InputError("terms", what);
}

}  // namespace

TermSet TermSet::from(std::string_view specification, std::span<const std::string> inputs,
                      std::size_t velocities) {
  std::string_view wanted = trimmed(specification);
  if (constexpr std::string_view kCounted = "fossen:"; wanted.starts_with(kCounted)) {
    double count = 0.0;
    if (!parse_number(wanted.substr(kCounted.size()), count) || !(count >= 1.0) ||
        count > kMostInputs || count != std::floor(count)) {
      reject_terms("'" + std::string(wanted) +
                   "' needs a whole number of velocities after the colon");
    }
    velocities = static_cast<std::size_t>(count);
    wanted = "fossen";
  }
  std::vector<std::string> texts;
  std::size_t without_products = kMostTerms;
  Attitude attitude;
  if (wanted == kAuto || wanted == kAutoDegrees || wanted == "quadratic") {
    attitude = attitude_for(wanted, inputs);
    const MotionTerms terms =
        MotionTerms::quadratic(inputs.size(), named_velocities(inputs), attitude);
    texts = terms.texts(inputs);
    without_products = terms.without_products();
    if (texts.size() > kMostTerms) {
      texts.resize(without_products);
    }
  } else if (wanted == "linear") {
    texts = MotionTerms::linear(inputs.size()).texts(inputs);
  } else if (wanted == "fossen" || wanted == "manoeuvring" || wanted == "6dof") {
    const bool six = wanted == "6dof";
    const bool cross_flow = wanted == "manoeuvring";
    if (velocities == 0 || velocities > inputs.size() || (six && velocities != kSixDegrees)) {
      reject_terms("'" + std::string(wanted) + "' needs " + (six ? "six" : "the") +
                   " velocities as first inputs, one per target; there are " +
                   std::to_string(velocities) + " targets and " + std::to_string(inputs.size()) +
                   " inputs");
    }
    std::vector<std::size_t> first(velocities);
    std::iota(first.begin(), first.end(), std::size_t{0});
    texts = MotionTerms::fossen(inputs.size(), first, six || cross_flow, cross_flow).texts(inputs);
  } else if (wanted != "none") {
    texts = split_text(wanted, ';');
  }
  TermSet set = parsed(texts, inputs);
  set.without_products_ = std::min(without_products, set.size());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (attitude.contains(i)) {
      set.attitude_.push_back(i);
    }
  }
  return set;
}

TermSet TermSet::open_loop(std::span<const std::string> inputs, std::span<const std::size_t> states,
                           const Attitude& attitude) {
  if (states.empty()) {
    return {};
  }
  const MotionTerms terms =
      MotionTerms::open_loop(inputs.size(), states, kMostOpenLoopTerms, attitude);
  if (terms.size() > kMostTerms) {
    return {};
  }
  TermSet set = parsed(terms.texts(inputs), inputs);
  set.without_products_ = terms.without_inflow();
  return set;
}

TermSet TermSet::baseline(std::span<const std::string> inputs, std::size_t velocities) {
  return parsed(MotionTerms::baseline(inputs.size(), velocities).texts(inputs), inputs);
}

TermSet TermSet::parsed(const std::vector<std::string>& texts,
                        std::span<const std::string> inputs) {
  if (texts.size() > kMostTerms) {
    reject_terms(std::to_string(texts.size()) + " given; a model takes at most " +
                 std::to_string(kMostTerms));
  }
  TermSet set;
  for (const std::string& text : texts) {
    set.terms_.push_back(Expression::parse(text, inputs));
  }
  set.without_products_ = set.size();
  return set;
}

double TermSet::power(std::size_t k, std::size_t input) const {
  const Expression& term = terms_[k];
  if (std::ranges::find(term.columns(), input) == term.columns().end()) {
    return 0.0;
  }
  ShortVector<kMostInputs> values(std::max(input, term.columns().back()) + 1);
  const std::span<double> x(values.data(), values.size());
  double power = std::numeric_limits<double>::quiet_NaN();
  for (const double sign : {1.0, -1.0}) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = 1.0 + 0.37 * static_cast<double>(i);
    }
    const double one = sign * x[input];
    const auto at = [&](double scale) {
      x[input] = scale * one;
      return term(x);
    };
    const double twice = std::log2(at(2.0) / at(1.0));
    const double threefold = std::log(at(3.0) / at(1.0)) / std::log(3.0);
    if (at(1.0) == 0.0 && at(2.0) == 0.0) {
      continue;  // a term of one direction of the command
    }
    if (!(std::abs(twice - threefold) < 1e-9) || std::abs(twice - power) > 1e-9) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    power = twice;
  }
  return power;
}

std::vector<std::string> TermSet::texts() const {
  std::vector<std::string> list;
  std::ranges::transform(terms_, std::back_inserter(list), &Expression::text);
  return list;
}

void TermSet::evaluate(std::span<const double> x, std::span<double> out) const {
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const double value = terms_[k](x);
    out[k] = std::isfinite(value) ? value : 0.0;
  }
}

void TermSet::add_gradient(std::span<const double> x, std::span<const double> weights,
                           std::span<double> gradient) const {
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    for (const std::size_t column : terms_[k].columns()) {
      const auto [value, slope] = terms_[k].slope(x, column);
      if (std::isfinite(value) && std::isfinite(slope)) {
        gradient[column] += weights[k] * slope;
      }
    }
  }
}

void TermSet::scales(const Moments& inputs, const Moments& terms, std::span<double> scales) const {
  const auto root_mean_square = [](const Moments& moments, std::size_t i) {
    return std::sqrt(moments.covariance(i, i) + moments.mean()[i] * moments.mean()[i]);
  };
  ScaledInput far(inputs.dimension());
  ShortVector<kMostTerms> at_far(size());
  for (std::size_t k = 0; k < size(); ++k) {
    scales[k] = root_mean_square(terms, k);
  }
  for (const double sign : {2.0, -2.0}) {
    for (std::size_t i = 0; i < far.size(); ++i) {
      far[i] = sign * root_mean_square(inputs, i);
    }
    evaluate(as_span(far), at_far);
    for (std::size_t k = 0; k < size(); ++k) {
      scales[k] = std::max(scales[k], 0.25 * std::abs(at_far[k]));
    }
  }
  std::ranges::replace_if(
      scales, [](double scale) { return !(scale > 0.0); }, 1.0);
}

ScaledSample scale_sample(const AxisScaling& scaling, const TermSet& terms,
                          std::span<const double> x) {
  ScaledSample sample(x.size() + terms.size());
  std::ranges::copy(scaling.input.apply(x), sample.begin());
  const std::span<double> phi = std::span(sample).subspan(x.size());
  terms.evaluate(x, phi);
  for (std::size_t k = 0; k < phi.size(); ++k) {
    phi[k] /= scaling.term_scale[k];
  }
  return sample;
}

}  // namespace kelpie
