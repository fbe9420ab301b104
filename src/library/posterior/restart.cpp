// SPDX-License-Identifier: Apache-2.0
#include "posterior/restart.hpp"

#include <algorithm>
#include <utility>

#include "core/vector.hpp"
#include "posterior/tuning.hpp"

namespace kelpie {

Restart::Restart(std::size_t terms, double enough, double ahead_s)
    : terms_(terms), ahead_s_(ahead_s), young_(terms, terms), evidence_(enough) {
  scored_weights_.reserve(terms);
  next_weights_.reserve(terms);
}

void Restart::begin(std::size_t row, double t, double until_s) {
  young_.clear();
  row_ = row;
  begin_s_ = t;
  until_s_ = until_s;
  scored_ = explained_ = 0.0;
  scored_weights_.clear();
  next_weights_.clear();
  kept_s_ = t;
  forget_evidence();
}

void Restart::begin_from(const Posterior& live, double kept, double t,
                         std::span<const std::uint8_t> group) {
  begin(0, t, t);
  young_.assign_first(live);
  young_.tell_anew({}, {}, kept);
  settle(young_, group);
}

void Restart::update(std::span<const double> phi, double y, double t, double trust,
                     const Posterior& live, double alike, std::span<const std::uint8_t> group) {
  const std::span<const double> terms = phi.first(terms_);
  if (live.ready() && !scored_weights_.empty()) {
    const double error = y - value(live, phi);
    const double own = y - dot({scored_weights_.data(), terms_}, terms);
    const double gain = Evidence::gain(error, own, std::min(live.noise(), young_.noise()));
    scored_ += 1.0;
    explained_ += Evidence::gain(y - young_.centre(), own, young_.noise());
    const double own_tau =
        std::min(young_.rows_per_sample(), kPosterior.most_correlated * scored_ + 1.0);
    evidence_.add(gain, std::max(alike, own_tau));
  }
  young_.add(terms, y, trust, Likelihood::student);
  if (young_.wants_solve()) {
    settle(young_, group);
  }
  keep_weights(t);
}

void Restart::keep_weights(double t) {
  if (!young_.ready() || t - kept_s_ < ahead_s_) {
    return;
  }
  kept_s_ = t;
  std::swap(scored_weights_, next_weights_);
  const std::span<const double> weights = young_.weights();
  next_weights_.assign(weights.begin(), weights.end());
  next_weights_[0] += young_.centre();
}

bool Restart::wins(double t, double learned_s) const {
  return evidence_.is_clear() && t - begin_s_ > std::min(kPosterior.garbage_s, learned_s);
}

void Restart::visit(Archive& archive) {
  archive.part("young", young_);
  for (RoomyVector<double>* const weights : {&scored_weights_, &next_weights_}) {
    archive.list(*weights, terms_, [&](double& one) { archive.number(one); });
  }
  archive.whole(row_);
  for (double* const one : {&kept_s_, &begin_s_, &until_s_, &scored_, &explained_}) {
    archive.number(*one);
  }
  archive.part("evidence", evidence_);
}

}  // namespace kelpie
