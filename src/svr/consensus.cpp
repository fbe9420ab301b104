// SPDX-License-Identifier: Apache-2.0
#include "kelpie/svr/consensus.hpp"

#include <algorithm>
#include <array>

#include "kelpie/core/scaling.hpp"
#include "kelpie/core/vector.hpp"

namespace kelpie {
namespace {

// Calls `add(share, function)` for every member, whoever owns it.
template <typename Add>
void for_each(std::span<const Voice> voices, Add add) {
  for (const Voice& voice : voices) {
    add(voice.share, *voice.function);
  }
}

template <typename Add>
void for_each(const std::vector<Consensus::Member>& members, Add add) {
  for (const Consensus::Member& member : members) {
    add(member.share, member.function);
  }
}

template <typename Voices>
double value_of(const Voices& voices, const Bounds& bounds, std::span<const double> x) {
  double sum = 0.0;
  for_each(voices, [&](double share, const SvrFunction& function) {
    sum += share * std::clamp(function(x), bounds.low, bounds.high);
  });
  return sum;
}

template <typename Voices>
double value_and_gradient(const Voices& voices, const Bounds& bounds, std::span<const double> x,
                          std::span<double> gradient) {
  std::array<double, kMostInputs + kMostTerms> slopes{};
  const std::span<double> own = std::span(slopes).first(x.size());
  std::ranges::fill(gradient, 0.0);
  double sum = 0.0;
  for_each(voices, [&](double share, const SvrFunction& function) {
    const double said = function.with_gradient(x, own);
    sum += share * std::clamp(said, bounds.low, bounds.high);
    if (said > bounds.low && said < bounds.high) {
      add_scaled(share, std::span<const double>(own), gradient);
    }
  });
  return sum;
}

}  // namespace

double consensus(std::span<const Voice> voices, const Bounds& bounds, std::span<const double> x) {
  return value_of(voices, bounds, x);
}

double consensus_with_gradient(std::span<const Voice> voices, const Bounds& bounds,
                               std::span<const double> x, std::span<double> gradient) {
  return value_and_gradient(voices, bounds, x, gradient);
}

double Consensus::operator()(std::span<const double> x) const {
  return value_of(members, bounds, x);
}

double Consensus::with_gradient(std::span<const double> x, std::span<double> gradient) const {
  return value_and_gradient(members, bounds, x, gradient);
}

double Consensus::term_weight(std::size_t k) const {
  double sum = 0.0;
  for (const Member& member : members) {
    sum += member.share * member.function.term_weights()[k];
  }
  return sum;
}

}  // namespace kelpie
