// SPDX-License-Identifier: Apache-2.0
#include "learner/change_detector.hpp"

#include <algorithm>
#include <cmath>

#include "learner/tuning.hpp"

namespace kelpie {
Suspicion ChangeDetector::inspect(const Errors& errors, double misfit, double t) {
  return trying_ ? compare(errors) : watch(errors.champion, misfit, t);
}

void ChangeDetector::visit(Archive& archive) {
  archive.flag(trying_);
  archive.flag(probation_);
  archive.flag(expects_);
  archive.part("alarm", alarm_);
  archive.number(lead_);
  archive.number(over_all_);
  archive.number(over_offset_);
  archive.number(mean_error_);
  archive.number(misfit_);
  archive.whole(age_);
}

Suspicion ChangeDetector::watch(double champion, double misfit, double t) {
  if (!std::isfinite(misfit) || !alarm_.watch(std::abs(champion) / misfit, t)) {
    return Suspicion::none;
  }
  start(misfit, false);
  return Suspicion::raised;
}

void ChangeDetector::start(double misfit, bool probation) {
  trying_ = true;
  probation_ = probation;
  expects_ = false;
  misfit_ = misfit;
  lead_ = 0.0;
  over_all_ = 0.0;
  over_offset_ = 0.0;
  mean_error_ = 0.0;
  age_ = 0;
}

void ChangeDetector::start_probation(double misfit) {
  alarm_.reset();
  start(misfit, true);
}

void ChangeDetector::dismiss() {
  trying_ = false;
  alarm_.reset();
}

void ChangeDetector::count(const Errors& errors) {
  ++age_;
  const double most = kOnline.alarm.clip * misfit_;
  if (errors.challenger && (probation_ || age_ > kOnline.change.burn_in)) {
    const auto lead = [&](double error) {
      return (std::min(std::abs(error), most) - std::min(std::abs(*errors.challenger), most)) /
                 misfit_ -
             kOnline.change.margin;
    };
    lead_ += lead(errors.champion);
    over_all_ += lead(errors.all);
    over_offset_ += lead(errors.champion - mean_error_);
  }
  mean_error_ += std::clamp(errors.champion - mean_error_, -most, most) / age_;
}

Suspicion ChangeDetector::compare(const Errors& errors) {
  count(errors);
  if (probation_) {
    lead_ = std::max(lead_, 0.0);
  }
  const double enough = expects_ ? kOnline.change.expected_win : kOnline.change.win;
  const bool won =
      lead_ > enough && (probation_ || std::min(over_all_, over_offset_) > enough / 2.0);
  if (!won && lead_ >= kOnline.change.loss && age_ < kOnline.change.patience) {
    return Suspicion::none;
  }
  const Suspicion verdict = !won         ? Suspicion::dismissed
                            : probation_ ? Suspicion::withdrawn
                                         : Suspicion::confirmed;
  if (verdict == Suspicion::confirmed) {
    start_probation(misfit_);
  } else {
    dismiss();
  }
  return verdict;
}

}  // namespace kelpie
