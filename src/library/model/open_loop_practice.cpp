// SPDX-License-Identifier: Apache-2.0
#include "model/open_loop_practice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "model/tuning.hpp"

namespace kelpie {
namespace {

constexpr const auto& kPractice = kModelTuning.practice;

}  // namespace

OpenLoopPractice::OpenLoopPractice(std::size_t inputs, std::vector<std::size_t> states,
                                   AttitudeMotion attitude)
    : states_(std::move(states)),
      attitude_(std::move(attitude)),
      integrated_(states_),
      held_(states_.size()),
      from_(inputs),
      at_(inputs),
      moments_(states_.size() * kPractisedAges.size()) {
  integrated_.insert(integrated_.end(), attitude_.inputs().begin(), attitude_.inputs().end());
  now_.resize(integrated_.size());
  a_ = b_ = {now_, now_};
}

void OpenLoopPractice::begin(std::span<const double> x) {
  from_.assign(x.begin(), x.end());
  for (std::size_t i = 0; i < integrated_.size(); ++i) {
    a_.value[i] = b_.value[i] = x[integrated_[i]];
  }
  std::copy_n(a_.value.begin(), held_.size(), held_.begin());
  running_ = true;
  age_s_ = 0.0;
  last_step_s_ = 0.0;
  next_ = 0;
}

void OpenLoopPractice::go_on(std::span<const double> x, double step_s, const Accelerations& a,
                             const Accelerations& b, std::span<const Extremes> seen) {
  advance(a_, a, step_s, seen);
  advance(b_, b, step_s, seen);
  from_.assign(x.begin(), x.end());
  age_s_ += step_s;
  last_step_s_ = step_s;
  while (next_ < kPractisedAges.size() && age_s_ >= kPractisedAges[next_] - 0.5 * step_s) {
    score(x);
    ++next_;
  }
  running_ = next_ < kPractisedAges.size();
}

void OpenLoopPractice::advance(Path& path, const Accelerations& accelerations, double step_s,
                               std::span<const Extremes> seen) {
  at_ = from_;
  for (std::size_t i = 0; i < integrated_.size(); ++i) {
    at_[integrated_[i]] = path.value[i];
  }
  const std::span<double> now(now_);
  accelerations(at_, now.first(states_.size()));
  attitude_.rates(at_, now.subspan(states_.size()));
  const double back = last_step_s_ > 0.0 ? 0.5 * step_s / last_step_s_ : 0.0;
  for (std::size_t i = 0; i < integrated_.size(); ++i) {
    const double ahead = path.value[i] + step_s * ((1.0 + back) * now_[i] - back * path.before[i]);
    if (!std::isfinite(ahead)) {
      continue;
    }
    const Extremes& range = seen[integrated_[i]];
    const double leeway = kModelTuning.rollout.leeway * (range.high - range.low);
    path.value[i] =
        i < states_.size() ? std::clamp(ahead, range.low - leeway, range.high + leeway) : ahead;
  }
  std::swap(path.before, now_);
}

void OpenLoopPractice::score(std::span<const double> x) {
  double& scored = scored_[next_];
  scored = std::min(scored + 1.0, kPractice.memory);
  const auto average = [&](double& mean, double value) { mean += (value - mean) / scored; };
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const double measured = x[states_[i]];
    const double a = a_.value[i] - measured;
    const double b = b_.value[i] - measured;
    const double h = held_[i] - measured;
    Moments& mean = moments_[i * kPractisedAges.size() + next_];
    average(mean.aa, a * a);
    average(mean.ab, a * b);
    average(mean.bb, b * b);
    average(mean.ah, a * h);
    average(mean.bh, b * h);
    average(mean.hh, h * h);
  }
}

void OpenLoopPractice::restart() {
  running_ = false;
  for (double& scored : scored_) {
    scored = std::min(scored, kPractice.few);
  }
}

double OpenLoopPractice::share(std::size_t state) const {
  double sum = 0.0;
  double weights = 0.0;
  for (std::size_t age = 0; age < kPractisedAges.size(); ++age) {
    const Moments& mean = moments(state, age);
    if (mean.aa > 0.0 && mean.bb > 0.0) {
      const double weight = scored_[age] / (scored_[age] + kPractice.assumed);
      sum += weight * std::log(mean.bb / mean.aa);
      weights += 1.0;
    }
  }
  return weights > 0.0 ? 1.0 / (1.0 + std::exp(-sum / weights)) : 0.5;
}

OpenLoopPractice::Mixture OpenLoopPractice::mixture(std::size_t state, std::size_t age) const {
  const double s = share(state);
  const Moments& mean = moments(state, age);
  return {.mm = s * s * mean.aa + 2.0 * s * (1.0 - s) * mean.ab + (1.0 - s) * (1.0 - s) * mean.bb,
          .mh = s * mean.ah + (1.0 - s) * mean.bh,
          .hh = mean.hh};
}

// The least of E (h + c (m − h))², drawn to c = 1 as by a few stretches more.
double OpenLoopPractice::kept_at(const Mixture& errors, std::size_t age) const {
  const double change = errors.mm - 2.0 * errors.mh + errors.hh;
  if (!(change > 0.0)) {
    return 1.0;
  }
  const double best = (errors.hh - errors.mh) / change;
  const double scored = scored_[age];
  return std::clamp((scored * best + kPractice.assumed) / (scored + kPractice.assumed), 0.0, 1.0);
}

ByAge OpenLoopPractice::kept(std::size_t state) const {
  ByAge kept{};
  for (std::size_t age = 0; age < kept.size(); ++age) {
    kept[age] = kept_at(mixture(state, age), age);
  }
  return kept;
}

ByAge OpenLoopPractice::off(std::size_t state) const {
  ByAge off{};
  for (std::size_t age = 0; age < off.size(); ++age) {
    const Mixture errors = mixture(state, age);
    const double c = kept_at(errors, age);
    const double square =
        c * c * errors.mm + 2.0 * c * (1.0 - c) * errors.mh + (1.0 - c) * (1.0 - c) * errors.hh;
    off[age] = scored_[age] > 0.0 ? std::sqrt(std::max(square, 0.0))
                                  : std::numeric_limits<double>::quiet_NaN();
  }
  return off;
}

void OpenLoopPractice::visit(Archive& archive) {
  for (Path* const path : {&a_, &b_}) {
    archive.numbers(path->value);
    archive.numbers(path->before);
  }
  archive.numbers(held_);
  archive.numbers(from_);
  archive.flag(running_);
  archive.number(age_s_);
  archive.number(last_step_s_);
  archive.whole(next_, std::size_t{0}, kPractisedAges.size());
  for (Moments& mean : moments_) {
    for (double* const number : {&mean.aa, &mean.ab, &mean.bb, &mean.ah, &mean.bh, &mean.hh}) {
      archive.number(*number);
    }
  }
  archive.numbers(scored_);
}

}  // namespace kelpie
