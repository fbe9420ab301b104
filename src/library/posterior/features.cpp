// SPDX-License-Identifier: Apache-2.0
#include "posterior/features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "posterior/posterior.hpp"
#include "posterior/tuning.hpp"

namespace kelpie {
namespace {

constexpr double kTiny = 1e-12;  // of the mean: rounding
constexpr ValueRange kNowhere{std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity()};

// Degrees in velocities and in commands, and the number of inputs: terms alike share a width.
std::array<double, 3> degrees(const TermSet& terms, std::size_t k, std::size_t inputs,
                              std::span<const std::size_t> states) {
  std::array<double, 3> degrees{};
  for (std::size_t i = 0; i < inputs; ++i) {
    const double power = terms.power(k, i);
    const bool is_state = std::ranges::find(states, i) != states.end();
    degrees.at(is_state ? 0 : 1) += std::isfinite(power) ? power : -1.0;
    degrees[2] += power != 0.0 ? 1.0 : 0.0;
  }
  return degrees;
}

}  // namespace

Features::Features(std::size_t inputs, TermSet terms, std::span<const std::size_t> states,
                   std::size_t centres)
    : terms_(std::move(terms)),
      states_(states.begin(), states.end()),
      basis_(kPosterior.gamma * std::sqrt(6.0 / static_cast<double>(inputs)), inputs, centres),
      units_{std::vector<double>(inputs), Matrix(inputs, inputs)},
      mean_(inputs),
      scatter_(inputs),
      ranges_(inputs, kNowhere) {
  std::map<std::array<double, 3>, std::uint8_t> known;
  groups_.push_back(FeatureGroup::kFlat);
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const auto next =
        static_cast<std::uint8_t>(std::min(known.size() + 1, FeatureGroup::kMost - 1));
    groups_.push_back(known.emplace(degrees(terms_, k, inputs, states), next).first->second);
  }
  groups_.resize(capacity(), FeatureGroup::kKernel);
  last_.resize(inputs);
  phi_.resize(capacity());
  watched_ = states_;
  if (states_.empty()) {  // any input may be a velocity
    watched_.resize(inputs);
    std::iota(watched_.begin(), watched_.end(), std::size_t{0});
  }
}

double Features::trust(std::span<const double> x) const {
  double most = 1.0;
  for (const std::size_t i : watched_) {
    most = std::max(most, std::abs(x[i] - units_.mean[i]) * units_.whitening(i, i));
  }
  return most <= kPosterior.far ? 1.0 : std::pow(kPosterior.far / most, 4);
}

std::optional<Matrix> Features::observe(std::span<const double> x, double trust) {
  rows_ += 1.0;
  weight_ += trust;
  bool is_outgrown = !has_units() && rows_ >= kPosterior.first_rows;
  std::vector<double>& mean = mean_;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (trust == 1.0) {
      ranges_[i] = {std::min(ranges_[i].low, x[i]), std::max(ranges_[i].high, x[i])};
    }
    const double before = x[i] - mean[i];
    mean[i] += trust / weight_ * before;
    scatter_[i] += trust * before * (x[i] - mean[i]);
    const double deviation = std::sqrt(scatter_[i] / weight_);
    const double unit = units_.whitening(i, i);
    const bool moves = deviation > kTiny * std::abs(mean[i]);
    const bool is_left_out = std::ranges::find(terms_.attitude(), i) != terms_.attitude().end();
    is_outgrown |= has_units() && moves && !is_left_out &&
                   (unit == 0.0 || deviation * unit > kPosterior.outgrown);
  }
  if (!is_outgrown) {
    return {};
  }
  std::vector<double> ratio(x.size()), shift(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double deviation = std::sqrt(scatter_[i] / weight_);
    const bool is_left_out = std::ranges::find(terms_.attitude(), i) != terms_.attitude().end();
    const double old_unit = units_.whitening(i, i);
    const double unit =
        !is_left_out && deviation > kTiny * std::abs(mean[i]) ? 1.0 / deviation : old_unit;
    // An input that was constant so far stands at that value in every centre.
    ratio[i] = old_unit > 0.0 ? unit / old_unit : 0.0;
    shift[i] = (units_.mean[i] - mean[i]) * unit;
    units_.mean[i] = mean[i];
    units_.whitening(i, i) = unit;
  }
  weight_at_units_ = weight_;
  is_current_ = false;
  return basis_.move(ratio, shift, kPosterior.novelty / 2.0);
}

void Features::first(std::span<const double> x, std::span<double> phi) const {
  phi[0] = 1.0;
  terms_.evaluate(x, phi.subspan(1, terms_.size()));
}

std::span<const double> Features::evaluate(std::span<const double> x) {
  if (is_current_ && std::ranges::equal(x, last_)) {
    return std::span(phi_).first(size());
  }
  std::ranges::copy(x, last_.begin());
  is_current_ = true;
  first(x, phi_);
  novelty_ = 0.0;
  if (has_units()) {
    const ScaledInput z = units_.apply(x);
    novelty_ = basis_.evaluate(as_span(z), std::span(phi_).subspan(terms_end(), basis_.size()));
  }
  return std::span(phi_).first(size());
}

std::span<const double> Features::learn(std::span<const double> x) {
  evaluate(x);
  const std::size_t functions = basis_.size();
  if (novelty_ > kPosterior.novelty && functions < basis_.centres().capacity()) {
    const ScaledInput z = units_.apply(x);
    basis_.add(as_span(z), std::span(phi_).subspan(terms_end(), functions), novelty_);
    phi_[terms_end() + functions] = std::sqrt(novelty_);
    is_current_ = false;
  }
  return std::span(phi_).first(size());
}

void Features::clear() {
  *this = Features(units_.dimension(), terms_, states_, basis_.centres().capacity());
}

void Features::visit(Archive& archive) {
  archive.number(rows_);
  archive.number(weight_);
  archive.number(weight_at_units_);
  archive.numbers(mean_);
  archive.numbers(scatter_);
  archive.numbers(units_.mean);
  archive.numbers(units_.whitening.values());
  for (ValueRange& range : ranges_) {
    archive.any_number(range.low);
    archive.any_number(range.high);
  }
  archive.part("kernel", basis_);
  is_current_ = is_current_ && !archive.loading();
}

}  // namespace kelpie
