// SPDX-License-Identifier: Apache-2.0
#include "posterior/restart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "posterior/tuning.hpp"

namespace kelpie {

void Restart::begin(std::size_t row, double t, double until_s) {
  young_.clear();
  row_ = row;
  begin_s_ = t;
  until_s_ = until_s;
  scored_ = 0.0;
  forget_evidence();
}

void Restart::update(std::span<const double> phi, double y, double trust, const Posterior& live,
                     std::span<const std::uint8_t> group) {
  const std::span<const double> terms = phi.first(terms_);
  if (live.ready() && young_.ready()) {
    const double error = y - live.value(phi);
    const double own = y - young_.value(terms);
    const double floor = kPosterior.least_error * std::min(live.noise(), young_.noise()) +
                         std::numeric_limits<double>::min();
    const double ratio = 0.5 * std::log((error * error + floor) / (own * own + floor));
    const double gain = std::clamp(ratio, -kPosterior.most_ratio, kPosterior.most_ratio);
    scored_ += 1.0;
    evidence_ +=
        gain / std::min(young_.rows_per_sample(), kPosterior.most_correlated * scored_ + 1.0);
    sum_ += gain;
    rows_ += 1.0;
    if (evidence_ <= 0.0) {
      forget_evidence();
    }
  }
  young_.add(terms, y, trust, Likelihood::student);
  if (young_.wants_solve()) {
    settle(young_, group);
  }
}

bool Restart::wins(double t, double learned_s) const {
  return evidence_ > kPosterior.nats && sum_ > kPosterior.nats_per_row * rows_ &&
         t - begin_s_ > std::min(kPosterior.garbage_s, learned_s);
}

void Restart::visit(Archive& archive) {
  archive.part("young", young_);
  archive.whole(row_);
  for (double* const one : {&begin_s_, &until_s_, &scored_, &evidence_, &sum_, &rows_}) {
    archive.number(*one);
  }
}

}  // namespace kelpie
