// SPDX-License-Identifier: Apache-2.0
#include "kelpie/online/change_detector.hpp"

#include <algorithm>
#include <cmath>

namespace kelpie {
namespace {

// All in usual errors. A Gaussian error exceeds the drift once in 20 samples.
constexpr double kMost = 5.0;    // that one sample counts
constexpr double kDrift = 2.0;   // that every sample may have
constexpr double kAlarm = 20.0;  // at least seven bad samples in a row

constexpr int kBurnIn = 20;  // samples a challenger learns before it is judged
constexpr double kMargin = 0.5;
constexpr double kWin = 60.0;
constexpr double kLoss = -40.0;
constexpr int kPatience = 500;  // samples after which a challenger that hasn't won has lost

}  // namespace

Suspicion ChangeDetector::judge(double champion, std::optional<double> challenger, double usual,
                                double t) {
  return trying_ ? compare(champion, challenger) : watch(champion, usual, t);
}

void ChangeDetector::visit(Archive& archive) {
  archive.flag(trying_);
  archive.number(alarm_);
  archive.number(since_);
  archive.number(lead_);
  archive.number(usual_);
  archive.whole(age_);
}

Suspicion ChangeDetector::watch(double champion, double usual, double t) {
  if (!std::isfinite(usual)) {
    return Suspicion::none;
  }
  if (alarm_ == 0.0) {
    since_ = t;
  }
  alarm_ = std::max(0.0, alarm_ + std::min(champion / usual, kMost) - kDrift);
  if (alarm_ <= kAlarm) {
    return Suspicion::none;
  }
  trying_ = true;
  usual_ = usual;
  lead_ = 0.0;
  age_ = 0;
  return Suspicion::raised;
}

void ChangeDetector::dismiss() {
  trying_ = false;
  alarm_ = 0.0;
}

Suspicion ChangeDetector::compare(double champion, std::optional<double> challenger) {
  ++age_;
  if (challenger && age_ > kBurnIn) {
    const double most = kMost * usual_;
    lead_ += (std::min(champion, most) - std::min(*challenger, most)) / usual_ - kMargin;
  }
  const bool won = lead_ > kWin;
  if (!won && lead_ >= kLoss && age_ < kPatience) {
    return Suspicion::none;
  }
  dismiss();
  return won ? Suspicion::confirmed : Suspicion::dismissed;
}

}  // namespace kelpie
