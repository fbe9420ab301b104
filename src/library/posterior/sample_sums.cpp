// SPDX-License-Identifier: Apache-2.0
#include "posterior/sample_sums.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/vector.hpp"

namespace kelpie {

void SampleSums::clear() {
  gram.resize(0);
  moment.clear();
  origin = rows = weight = square = 0.0;
}

void SampleSums::add(std::span<const double> phi, double y, double w) {
  origin = rows == 0.0 ? y : origin;
  y -= origin;
  gram.resize(phi.size());
  moment.resize(phi.size());
  gram.add_square(w, phi);
  add_scaled(w * y, phi, {moment.data(), moment.size()});
  rows += 1.0;
  weight += w;
  square += w * y * y;
}

void SampleSums::add(const SampleSums& other, std::size_t features, double share) {
  origin = rows == 0.0 ? other.origin : origin;
  const double ahead = other.origin - origin;
  gram.resize(std::max(gram.size(), features));
  moment.resize(gram.size());
  for (std::size_t i = 0; i < features; ++i) {
    const std::span<const double> row = other.gram.row(i);
    add_scaled(share, row, gram.row(i));
    moment[i] += share * (other.moment[i] + ahead * row[0]);
  }
  rows += share * other.rows;
  weight += share * other.weight;
  square += share * (other.square + 2.0 * ahead * other.moment[0] + ahead * ahead * other.weight);
}

void SampleSums::scale(double share) {
  gram.scale(share);
  for (double& one : moment) {
    one *= share;
  }
  for (double* const sum : {&rows, &weight, &square}) {
    *sum *= share;
  }
}

void SampleSums::tell_anew(std::span<const double> step) {
  const std::span<const double> first{moment.data(), step.size()};
  const double moved = dot(step, first);
  for (std::size_t i = 0; i < gram.size(); ++i) {
    const std::span<const double> row = gram.row(i);
    for (std::size_t j = 0; j < std::min(step.size(), i + 1); ++j) {
      moment[i] += row[j] * step[j];
      moment[j] += i < step.size() && j < i ? row[j] * step[i] : 0.0;
    }
  }
  square += moved + dot(step, first);
}

TargetScaling SampleSums::targets() const {
  if (weight == 0.0) {
    return {};
  }
  const double mean = moment[0] / weight;
  const double variance = square / weight - mean * mean;
  return {origin + mean, std::sqrt(std::max(variance, std::numeric_limits<double>::min()))};
}

double SampleSums::root_mean_square(std::size_t feature) const {
  return std::sqrt(gram.diagonal(feature) / weight);
}

template <typename Use>
void SampleSums::each(Use use) {
  for (double* const one : {&origin, &rows, &weight, &square}) {
    use(*one);
  }
  std::ranges::for_each(moment, use);
  for (std::size_t i = 0; i < gram.size(); ++i) {
    std::ranges::for_each(gram.row(i), use);
  }
}

void SampleSums::visit(Archive& archive) {
  std::size_t features = gram.size();
  archive.length(features, moment.capacity());
  gram.resize(features);
  moment.resize(features);
  each([&](double& one) { archive.number(one); });
}

std::vector<double> SampleSums::numbers() const {
  std::vector<double> list;
  SampleSums(*this).each([&](double one) { list.push_back(one); });
  return list;
}

void SampleSums::assign(std::size_t features, std::span<const double> numbers) {
  gram.resize(features);
  moment.resize(features);
  auto next = numbers.begin();
  each([&](double& one) { one = *next++; });
}

}  // namespace kelpie
