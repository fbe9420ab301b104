// SPDX-License-Identifier: Apache-2.0
#include "model/open_loop_practice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/quantile.hpp"
#include "model/seen_velocities.hpp"
#include "model/tuning.hpp"

namespace kelpie {
namespace {

constexpr const auto& kPractice = kModelTuning.practice;

std::vector<double> values_of(const RecentValues& recent) {
  std::vector<double> values(recent.size());
  recent.copy_to(values);
  return values;
}

// e + share (f − e).
std::vector<double> mixed(std::vector<double> e, const std::vector<double>& f, double share) {
  for (std::size_t i = 0; i < e.size(); ++i) {
    e[i] += share * (f[i] - e[i]);
  }
  return e;
}

// Sums over stretches whose ratio is the share s with the least squares of e + s (f − e).
struct Gain {
  double gained = 0.0;
  double change = 0.0;

  void operator+=(const Gain& other) {
    gained += other.gained;
    change += other.change;
  }
  double share() const { return std::clamp(gained / change, 0.0, 1.0); }
};

// The newest stretch first. A stretch weighs 1/(square + median square of the newer half); in units
// of the mean square.
Gain gain_of(const std::vector<double>& e, const std::vector<double>& f,
             const std::vector<double>& squares) {
  std::vector<double> newer(squares.begin(),
                            squares.begin() + std::ssize(squares) / 2 + std::ssize(squares) % 2);
  const double usual = newer.empty() ? 0.0 : quantile(newer, 0.5);
  if (!(usual > 0.0)) {
    return {};
  }
  Gain sum;
  double unit = 0.0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    const double weight = 1.0 / (squares[i] + usual);
    sum.gained += weight * e[i] * (e[i] - f[i]);
    sum.change += weight * (e[i] - f[i]) * (e[i] - f[i]);
    unit += weight * squares[i];
  }
  const auto stretches = static_cast<double>(e.size());
  return {.gained = sum.gained * stretches / unit, .change = sum.change * stretches / unit};
}

// Mean squares of two errors, stretch by stretch.
std::vector<double> squares_of(const std::vector<double>& e, const std::vector<double>& f) {
  std::vector<double> squares(e.size());
  for (std::size_t i = 0; i < e.size(); ++i) {
    squares[i] = 0.5 * (e[i] * e[i] + f[i] * f[i]);
  }
  return squares;
}

}  // namespace

OpenLoopPractice::OpenLoopPractice(std::size_t inputs, std::vector<std::size_t> states,
                                   AttitudeMotion attitude)
    : states_(std::move(states)),
      attitude_(std::move(attitude)),
      integrated_(states_),
      held_(states_.size()),
      from_(inputs),
      at_(inputs),
      errors_(states_.size() * kPractisedAges.size(),
              {RecentValues(kPractice.stretches), RecentValues(kPractice.stretches),
               RecentValues(kPractice.stretches)}) {
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
    path.value[i] = i < states_.size() ? bounded_velocity(seen[integrated_[i]], ahead) : ahead;
  }
  std::swap(path.before, now_);
}

void OpenLoopPractice::score(std::span<const double> x) {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const double measured = x[states_[i]];
    Errors& errors = errors_[i * kPractisedAges.size() + next_];
    errors.a.add(a_.value[i] - measured);
    errors.b.add(b_.value[i] - measured);
    errors.held.add(held_[i] - measured);
  }
}

void OpenLoopPractice::restart() {
  running_ = false;
  for (Errors& errors : errors_) {
    for (RecentValues* const one : {&errors.a, &errors.b, &errors.held}) {
      one->keep(kPractice.few);
    }
  }
}

double OpenLoopPractice::share(std::size_t state) const {
  Gain sum{.gained = kPractice.assumed, .change = 2.0 * kPractice.assumed};
  for (std::size_t age = 0; age < kPractisedAges.size(); ++age) {
    const std::vector<double> a = values_of(errors(state, age).a);
    const std::vector<double> b = values_of(errors(state, age).b);
    sum += gain_of(b, a, squares_of(a, b));
  }
  return sum.share();
}

std::vector<double> OpenLoopPractice::mixture_errors(std::size_t state, std::size_t age,
                                                     double share) const {
  const Errors& e = errors(state, age);
  return mixed(values_of(e.b), values_of(e.a), share);
}

ByAge OpenLoopPractice::kept(std::size_t state) const {
  const double s = share(state);
  ByAge kept{};
  for (std::size_t age = 0; age < kept.size(); ++age) {
    Gain sum{.gained = kPractice.assumed, .change = kPractice.assumed};
    // Weighed by the model's errors alone: a stretch with a large change of velocity tells most.
    const std::vector<double> mixture = mixture_errors(state, age, s);
    sum += gain_of(values_of(errors(state, age).held), mixture, squares_of(mixture, mixture));
    kept[age] = sum.share();
  }
  return kept;
}

ByAge OpenLoopPractice::off(std::size_t state) const {
  const double s = share(state);
  const ByAge shares = kept(state);
  ByAge off{};
  for (std::size_t age = 0; age < off.size(); ++age) {
    std::vector<double> left =
        mixed(values_of(errors(state, age).held), mixture_errors(state, age, s), shares[age]);
    std::ranges::transform(left, left.begin(), [](double value) { return std::abs(value); });
    off[age] = left.empty() ? std::numeric_limits<double>::quiet_NaN()
                            : conformal_bound(left, kPractice.coverage) / kNormal90;
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
  for (Errors& errors : errors_) {
    for (RecentValues* const one : {&errors.a, &errors.b, &errors.held}) {
      one->visit(archive);
    }
  }
}

}  // namespace kelpie
