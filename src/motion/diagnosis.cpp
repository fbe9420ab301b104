// SPDX-License-Identifier: Apache-2.0
#include "kelpie/motion/diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/eigen.hpp"
#include "motion/archives.hpp"
#include "motion/maps.hpp"

namespace kelpie {
namespace {

constexpr double kBlockRows = 10.0;    // at least,
constexpr double kBlockS = 2.25;       // and at least as long from the first to the last
constexpr std::size_t kGuard = 2;      // blocks passed over where a change may lie
constexpr std::size_t kLeastLook = 4;  // blocks before anything is named
constexpr std::size_t kChance = 12;    // blocks after which what means nothing is taken back
constexpr std::size_t kSettled = 48;   // blocks after which a finding is done with
constexpr double kKeptNamed = 0.5;     // of the reference after a change with a name
constexpr double kKeptUnnamed = 0.02;  // … and after another
// What the equations leave out, as a share of a change: of coefficients that grow or shrink, and of
// accelerations and velocities that are added. Filters that accelerations went through weaken the
// equations as a whole, which is seen in the latter only. Chosen on simulated vehicles.
constexpr double kDiscrepancy = 0.004;
constexpr double kAddedDiscrepancy = 0.0125;
constexpr double kOutlier = 6.0;  // standard deviations

}  // namespace

Diagnosis::Diagnosis(std::size_t inputs, std::vector<std::size_t> states,
                     std::vector<std::size_t> body_axes)
    : watch_(inputs, states, std::move(body_axes)),
      standstill_(states),
      block_(watch_.basis().size(), states.size()),
      after_(block_),
      phi_(watch_.basis().size()),
      residual_(states.size()),
      delta_(phi_.size() * states.size()),
      tangent_(delta_.size()),
      alone_(watch_.explanations().list().size()) {
  findings_.reserve(kMostFindings);
}

void Diagnosis::update(std::span<const double> x, std::span<const double> y, double t) {
  const auto finite = [](double value) { return std::isfinite(value); };
  if (!std::ranges::all_of(x, finite) || !std::ranges::all_of(y, finite) || !finite(t) ||
      !moves(x, t)) {
    return;
  }
  watch_.basis().evaluate(x, phi_);
  if (ready() && is_outlier(y)) {
    return;
  }
  if (block_.rows() == 0.0) {
    block_start_ = t;
  }
  block_.add(phi_, y);
  if (!looking_ && watch_.step()) {
    open(t);
  }
  if (block_.rows() >= kBlockRows && t - block_start_ >= kBlockS) {
    close_block(t);
    block_.clear();
  }
}

// A jump that the next row doesn't share.
bool Diagnosis::is_outlier(std::span<const double> y) {
  const auto theta = matrix_of(watch_.fit().theta(), phi_.size());
  const auto precision = matrix_of(watch_.fit().precision(), y.size());
  auto residual = as_vector(residual_);
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    residual(i) = y[static_cast<std::size_t>(i)] - theta.col(i).dot(as_vector(phi_));
  }
  double square = 0.0;
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    square += residual(i) * precision.col(i).dot(residual);
  }
  const bool far = square > kOutlier * kOutlier * static_cast<double>(y.size());
  const bool alone = far && !outlier_before_;
  outlier_before_ = far;
  return alone;
}

// Rows of a sensor that has stopped say nothing of the vehicle.
bool Diagnosis::moves(std::span<const double> x, double t) {
  const bool before = standstill_.any();
  standstill_.update(x, t);
  const bool now = standstill_.any();
  if (now && !before) {
    freeze(t);
  }
  return !now;
}

void Diagnosis::freeze(double t) {
  std::size_t which = 0;
  while (!standstill_.frozen(which)) {
    ++which;
  }
  const double since = standstill_.since(which);
  const double value = standstill_.value(which);
  watch_.drop_since(since);
  Finding& finding = looking_ ? findings_.back() : add_finding(since, t);
  finding.state = FindingState::named;
  finding.told_s = t;
  finding.since_s = since;
  finding.settled = true;
  finding.count = 1;
  finding.explained = 1.0;
  finding.causes[0] = {CauseKind::frozen, standstill_.input(which), value, value, value};
  looking_ = false;
  block_.clear();
  guard_ = kGuard;
}

void Diagnosis::close_block(double t) {
  if (guard_ > 0) {
    --guard_;
  } else if (looking_) {
    after_.add(block_);
    ++looked_;
    look(t);
  } else {
    watch_.keep(block_, block_start_);
  }
}

void Diagnosis::open(double t) {
  after_.clear();
  const Watch::Part part = watch_.part(kGuard, after_);
  add_finding(part.since_s, t);
  looked_ = part.blocks - std::min(kGuard, part.blocks);
  guard_ = kGuard - std::min(kGuard, part.blocks);
  looking_ = true;
}

Finding& Diagnosis::add_finding(double since, double t) {
  if (findings_.size() == kMostFindings) {
    findings_.erase(findings_.begin());
  }
  ++found_;
  Finding& finding = findings_.emplace_back();
  finding.since_s = since;
  finding.found_s = finding.told_s = t;
  return finding;
}

void Diagnosis::look(double t) {
  watch_.compare(after_);
  for (std::size_t i = 0; i < alone_.size(); ++i) {
    alone_[i] = alone(i);
  }
  const Judgement judgement =
      judge_change(watch_.comparison(), watch_.explanations().list(), alone_, after_.rows(),
                   watch_.usual_scatter(), delta_.size());
  if (looked_ >= kLeastLook) {
    tell(findings_.back(), judgement, t);
  }
  const bool chance = judgement.state == FindingState::looking && looked_ >= kChance;
  if (chance || looked_ >= kSettled) {
    settle(judgement);
  }
}

// Gauss-Newton steps where the change isn't straight.
Agreement Diagnosis::alone(std::size_t explanation) {
  Agreement agreement = watch_.comparison().of(watch_.explanations().list()[explanation].columns);
  double size = agreement.size[0];
  constexpr int kSteps = 5;
  for (int step = 0; step < kSteps; ++step) {
    if (!watch_.explanations().curve(watch_.basis(), explanation, watch_.fit().theta(), size,
                                     delta_, tangent_)) {
      return agreement;
    }
    const Agreement further = watch_.comparison().beyond(delta_, tangent_);
    agreement.evidence = further.evidence;
    agreement.size[0] = size;
    agreement.error[0] = further.error[0];
    size += further.size[0];
  }
  return agreement;
}

void Diagnosis::tell(Finding& finding, const Judgement& judgement, double t) const {
  const Choice& best = judgement.best;
  const bool pair = best.other != best.one;
  const auto cause = [&](const Choice& choice, std::size_t explanation, std::size_t column) {
    const CauseKind kind = watch_.explanations().list()[explanation].kind;
    const bool added = kind == CauseKind::force || kind == CauseKind::sensor_bias;
    const double size = choice.agreement.size[column];
    const double scatter = std::sqrt(judgement.dispersion) * choice.agreement.error[column];
    const double left_out = (added ? kAddedDiscrepancy : kDiscrepancy) * size;
    return watch_.explanations().cause(explanation, size, kReach90 * std::hypot(scatter, left_out));
  };
  if (finding.state != judgement.state) {
    finding.state = judgement.state;
    finding.told_s = t;
  }
  finding.count = pair ? 2 : 1;
  finding.causes[0] = cause(best, best.one, 0);
  if (pair) {
    finding.causes[1] =
        cause(best, best.other, watch_.explanations().list()[best.one].columns.size());
  }
  finding.rival = cause(judgement.rival, judgement.rival.one, 0);
  finding.evidence = best.agreement.evidence / judgement.dispersion;
  finding.margin = judgement.margin;
  finding.explained = judgement.explained;
}

// From here on the vehicle is taken as it is: what the reference knows stays, but for what has
// changed. Where that isn't known, most of it goes. A finding of which nothing is left after all
// its rows was chance, and is taken back.
void Diagnosis::settle(const Judgement& judgement) {
  looking_ = false;
  if (judgement.state == FindingState::looking) {
    findings_.pop_back();
    --found_;
    watch_.go_on({}, 1.0, after_);
    return;
  }
  findings_.back().settled = true;
  if (judgement.state == FindingState::named) {
    know(judgement.best);
    watch_.go_on(delta_, kKeptNamed, after_);
  } else {
    watch_.go_on({}, kKeptUnnamed, after_);
  }
}

// What has changed of the coefficients, into delta_.
void Diagnosis::know(const Choice& choice) {
  const Explanations& explanations = watch_.explanations();
  const bool alone = choice.one == choice.other;
  if (alone && explanations.curve(watch_.basis(), choice.one, watch_.fit().theta(),
                                  choice.agreement.size[0], delta_, tangent_)) {
    return;
  }
  std::ranges::fill(delta_, 0.0);
  std::size_t next = 0;
  const auto add = [&](const Explanation& explanation) {
    for (const std::size_t column : explanation.columns) {
      as_vector(delta_) +=
          choice.agreement.size[next++] *
          as_vector(watch_.directions().subspan(column * delta_.size(), delta_.size()));
    }
  };
  add(explanations.list()[choice.one]);
  if (!alone) {
    add(explanations.list()[choice.other]);
  }
}

void Diagnosis::visit(Archive& archive) {
  archive.part("watch", watch_);
  archive.part("standstill", standstill_);
  archive.part("block", block_);
  archive.part("after", after_);
  archive.number(block_start_);
  archive.flag(looking_);
  archive.whole(guard_, 0, kGuard);
  archive.whole(looked_);
  archive.flag(outlier_before_);
  archive.whole(found_);
  archive.list(findings_, kMostFindings,
               [&](Finding& finding) { visit_finding(archive, finding); });
  archive.require(!looking_ || !findings_.empty(), "a change looked into that isn't there");
}

}  // namespace kelpie
