// SPDX-License-Identifier: Apache-2.0
#include "kelpie/online/change_detector.hpp"

#include <algorithm>
#include <cmath>

namespace kelpie {
namespace {

// All in usual misfits.
constexpr int kBurnIn = 20;  // samples a challenger learns before it is judged
constexpr double kMargin = 0.5;
constexpr double kWin = 60.0;
constexpr double kExpectedWin = 30.0;
constexpr double kLoss = -40.0;
constexpr int kPatience = 500;  // samples after which a challenger that hasn't won has lost

}  // namespace

Suspicion ChangeDetector::judge(double champion, std::optional<double> challenger, double misfit,
                                double t) {
  return trying_ ? compare(champion, challenger) : watch(champion, misfit, t);
}

void ChangeDetector::visit(Archive& archive) {
  archive.flag(trying_);
  archive.flag(probation_);
  archive.flag(expects_);
  archive.part("alarm", alarm_);
  archive.number(lead_);
  archive.number(misfit_);
  archive.whole(age_);
}

Suspicion ChangeDetector::watch(double champion, double misfit, double t) {
  if (!std::isfinite(misfit) || !alarm_.watch(champion / misfit, t)) {
    return Suspicion::none;
  }
  begin(misfit, false);
  return Suspicion::raised;
}

void ChangeDetector::begin(double misfit, bool probation) {
  trying_ = true;
  probation_ = probation;
  expects_ = false;
  misfit_ = misfit;
  lead_ = 0.0;
  age_ = 0;
}

void ChangeDetector::prove(double misfit) {
  alarm_.reset();
  begin(misfit, true);
}

void ChangeDetector::dismiss() {
  trying_ = false;
  alarm_.reset();
}

Suspicion ChangeDetector::compare(double champion, std::optional<double> challenger) {
  ++age_;
  if (challenger && (probation_ || age_ > kBurnIn)) {
    const double most = ErrorAlarm::kMost * misfit_;
    lead_ += (std::min(champion, most) - std::min(*challenger, most)) / misfit_ - kMargin;
  }
  if (probation_) {
    lead_ = std::max(lead_, 0.0);
  }
  const bool won = lead_ > (expects_ ? kExpectedWin : kWin);
  if (!won && lead_ >= kLoss && age_ < kPatience) {
    return Suspicion::none;
  }
  const Suspicion verdict = !won         ? Suspicion::dismissed
                            : probation_ ? Suspicion::withdrawn
                                         : Suspicion::confirmed;
  if (verdict == Suspicion::confirmed) {
    prove(misfit_);
  } else {
    dismiss();
  }
  return verdict;
}

}  // namespace kelpie
