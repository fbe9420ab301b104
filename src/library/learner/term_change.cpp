// SPDX-License-Identifier: Apache-2.0
#include "learner/term_change.hpp"

#include <algorithm>
#include <functional>

#include "core/vector.hpp"
#include "learner/sample_map.hpp"

namespace kelpie {

double TermChange::operator()(std::span<const double> z) const {
  const std::size_t terms = weights_.size() - 1;
  return any_ && z.size() == inputs_ + terms
             ? weights_.back() + dot(z.subspan(inputs_), std::span(weights_).first(terms))
             : 0.0;
}

void TermChange::add(std::span<const double> step) {
  std::ranges::transform(weights_, step, weights_.begin(), std::plus{});
  any_ = true;
}

void TermChange::clear() {
  std::ranges::fill(weights_, 0.0);
  any_ = false;
}

// The target's zero moves, too, which is not of a change.
void TermChange::rescale(const SampleMap& map, std::span<double> z) {
  const double gain = linear_part(map, z).gain;
  for (std::size_t k = 0; k + 1 < weights_.size(); ++k) {
    weights_[k] *= gain / z[inputs_ + k];
  }
  weights_.back() *= gain;
}

void TermChange::visit(Archive& archive) {
  archive.flag(any_);
  if (any_) {
    archive.numbers(weights_);
  } else if (archive.loading()) {
    clear();
  }
}

}  // namespace kelpie
