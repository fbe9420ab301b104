// SPDX-License-Identifier: Apache-2.0
#include "model/guarded_axis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "learner/valid_sample.hpp"
#include "model/tuning.hpp"

namespace kelpie {
namespace {

constexpr const auto& kGuard = kModelTuning.guard;
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Whether the later half of the samples stays within a small part of the scale: in the target, or
/// in an input. Constant columns tell nothing.
bool too_large(const AxisScaling& scaling, const ThinnedRows& rows) {
  const std::size_t half = rows.size() / 2;
  if (rows.size() - half < kGuard.least_half) {
    return false;
  }
  const Matrix covariance = scaling.input.covariance();
  const std::size_t inputs = scaling.input.dimension();
  for (std::size_t k = 0; k <= inputs; ++k) {
    double least = kNever;
    double most = -kNever;
    for (std::size_t i = half; i < rows.size(); ++i) {
      const double value = k < inputs ? rows[i].x[k] : rows[i].y;
      least = std::min(least, value);
      most = std::max(most, value);
    }
    const double deviation = k < inputs ? std::sqrt(covariance(k, k)) : scaling.target.scale;
    if (most > least && most - least < kGuard.tiny * deviation) {
      return true;
    }
  }
  return false;
}

}  // namespace

GuardedAxis::GuardedAxis(std::size_t inputs, const SharedSettings& shared,
                         const OnlineSvrSettings& settings, const TermSet& terms,
                         std::optional<AxisScaling> scaling, std::optional<SteadyPart> steady)
    : arguments_{inputs, shared, settings, terms, std::move(scaling), std::move(steady)},
      trusted_(arguments_.make()),
      guarded_(shared.track > 0.0),
      first_(inputs),
      young_until_(arguments_.scaling ? -kNever : kNever),
      refused_(inputs),
      before_(-kNever),
      feed_(inputs, 0) {}

void GuardedAxis::limit(const Budget& budget) {
  trusted_.limit(budget);
  if (candidate_) {
    candidate_->limit(budget);
  }
}

void GuardedAxis::alert(double since_s, bool another) {
  trusted_.alert(since_s, another);
  if (candidate_) {
    candidate_->alert(since_s, another);
  }
}

void GuardedAxis::resume_from(const AxisScaling& scaling, const FunctionMix& said, double t) {
  trusted_.resume_from(scaling, said, t);
  young_until_ = -kNever;
}

void GuardedAxis::learn_held_back() {
  while (feed_.size() > 0) {
    feed();
  }
  trusted_.learn_held_back();
}

const DynamicsAxis& GuardedAxis::answering(std::span<const double> x) const {
  return candidate_ && trusted_.scaling() != nullptr && !trusted_.plausible(x) ? *candidate_
                                                                               : trusted_;
}

// The way of a sample through the guard (docs/sample.md).
Decision GuardedAxis::update(std::span<const double> x, double y, double t) {
  trusted_last_ = true;
  if (!guarded_ || !valid_sample(x, arguments_.inputs, y, t)) {
    return trusted_.update(x, y, t);
  }
  const bool refused = trusted_.scaling() != nullptr && !trusted_.plausible(x, y);
  count_time(refused, t);
  const Decision decision = refused ? learn_doubted(x, y, t) : learn_trusted(x, y, t);
  feed();
  look(t);
  return decision;
}

void GuardedAxis::count_time(bool refused, double t) {
  if (young_until_ == kNever) {
    young_until_ = t + kGuard.young_s;
    next_look_ = t + kGuard.look_s;
  }
  const double kept = std::exp(-(t - std::max(before_, t - kGuard.look_s)) / kGuard.share_s);
  share_ = kept * share_ + (refused ? 1.0 - kept : 0.0);
  before_ = t;
}

Decision GuardedAxis::learn_trusted(std::span<const double> x, double y, double t) {
  if (++passed_ > run_) {
    run_ = 0;
    if (!candidate_) {
      refused_.clear();
    }
  }
  if (t <= young_until_) {
    first_.add(x, y, t);
  }
  if (feeds_trusted_ && feed_.size() > 0) {  // behind the samples of the new axis
    Decision decision{.verdict = Verdict::held_back,
                      .prediction = {.value = trusted_.predict(x)},
                      .had_model = trusted_.status().ready};
    feed_.hold(x, y, t);
    return decision;
  }
  return trusted_.update(x, y, t);
}

Decision GuardedAxis::learn_doubted(std::span<const double> x, double y, double t) {
  trusted_last_ = false;
  refused_.add(x, y, t);
  Decision decision{.verdict = Verdict::implausible,
                    .prediction = assess(x),
                    .had_model = trusted_.status().ready,
                    .kkt_gap = trusted_.status().kkt_gap};
  if (candidate_ && !feeds_trusted_ && feed_.size() > 0) {
    feed_.hold(x, y, t);
    decision.verdict = Verdict::held_back;
  } else if (candidate_ &&
             (candidate_->changes_scale() || arguments_.scaling || candidate_->plausible(x, y))) {
    evidence_.add(candidate_->predict(x), y, candidate_->scaling()->target.scale);
    const Prediction said = decision.prediction;
    decision = candidate_->update(x, y, t);
    decision.prediction = said;
    decision.suspected = decision.changed = decision.withdrawn = decision.returning = false;
    decision.recalled = 0;
    if (share_ > kGuard.confirmed_share || evidence_.convincing()) {
      trust_candidate(t);
    }
  } else {
    ++implausible_;
    doubt(t);
  }
  return decision;
}

// No axis has learned the sample.
void GuardedAxis::doubt(double t) {
  if (run_ == 0) {
    run_since_ = t;
    passed_ = 0;
  }
  ++run_;
  if (run_ >= kGuard.least_refused && t - run_since_ >= kGuard.believed_s) {
    begin_candidate(t);
  }
}

void GuardedAxis::begin_candidate(double t) {
  drop_candidate();
  candidate_.emplace(trusted_);
  candidate_->expect(refused_);
  begun_with_ = trusted_.status().tally;
  evidence_ = {};
  run_ = 0;
  next_look_ = t + kGuard.look_s;
  feeds_trusted_ = false;
  feed_ = WarmUp(arguments_.inputs, 2 * ThinnedRows::kMost);
  for (std::size_t i = 0; i < refused_.size(); ++i) {
    feed_.hold(refused_[i].x, refused_[i].y, refused_[i].t);
  }
}

void GuardedAxis::drop_candidate() {
  if (candidate_) {
    gone_.add(candidate_->status().tally);
    gone_.subtract(begun_with_);
    candidate_.reset();
  }
}

void GuardedAxis::trust_candidate(double t) {
  gone_.add(trusted_.status().tally);
  gone_.subtract(begun_with_);
  trusted_ = *candidate_;
  candidate_.reset();
  guarded_ = !arguments_.scaling;
  first_ = refused_;
  refused_.clear();
  run_ = 0;
  share_ = 0.0;
  young_until_ = t + kGuard.confirmed_young_s;
  next_look_ = t + kGuard.look_s;
}

// With the later half of the first samples; the former axis may still be right.
void GuardedAxis::begin_anew(double t) {
  drop_candidate();
  begun_with_ = {};
  candidate_.emplace(trusted_);
  trusted_ = arguments_.make();
  trusted_.set_past_models(candidate_->past_models());
  evidence_ = {};
  run_ = 0;
  share_ = 0.0;
  refused_.clear();
  feed_ = WarmUp(arguments_.inputs, 2 * ThinnedRows::kMost);
  feeds_trusted_ = true;
  const std::size_t half = first_.size() / 2;
  for (std::size_t i = half; i < first_.size(); ++i) {
    const WarmUp::Sample row = first_[i];
    if (i - half < static_cast<std::size_t>(arguments_.shared.warmup)) {
      trusted_.update(row.x, row.y, row.t);
    } else {
      feed_.hold(row.x, row.y, row.t);
    }
  }
  first_.keep_later_half();
  young_until_ = t + kGuard.confirmed_young_s;
}

void GuardedAxis::feed() {
  DynamicsAxis* const learner = feeds_trusted_ ? &trusted_ : candidate_ ? &*candidate_ : nullptr;
  for (std::size_t k = 0; k < kGuard.per_update && feed_.size() > 0 && learner != nullptr; ++k) {
    const WarmUp::Sample row = feed_[0];
    if (!feeds_trusted_ || trusted_.scaling() == nullptr || trusted_.plausible(row.x, row.y)) {
      learner->update(row.x, row.y, row.t);
    }
    feed_.drop_oldest(1);
  }
  if (feed_.size() == 0) {
    feeds_trusted_ = false;
  }
}

void GuardedAxis::look(double t) {
  if (t < next_look_) {
    return;
  }
  next_look_ = t + kGuard.look_s;
  if (feed_.size() > 0 || arguments_.scaling) {
    return;
  }
  if (t > young_until_) {
    first_.clear();
  } else if (trusted_.scaling() != nullptr && too_large(*trusted_.scaling(), first_)) {
    begin_anew(t);
    return;
  }
  if (candidate_ && too_large(*candidate_->scaling(), refused_)) {
    refused_.keep_later_half();
    begin_candidate(t);
  }
}

Status GuardedAxis::status() const {
  Status status = trusted_.status();
  status.tally.add(gone_);
  if (candidate_) {
    status.tally.add(candidate_->status().tally);
    status.tally.subtract(begun_with_);
  }
  status.tally.implausible += implausible_;
  return status;
}

void GuardedAxis::Evidence::add(double said, double was, double scale) {
  const auto clipped = [&](double error) {
    const double deviations = std::min(std::abs(error) / scale, kGuard.clip);
    return deviations * deviations;
  };
  if (samples > 0) {
    spread += clipped(was - mean);
    unexplained += clipped(was - said);
  }
  ++samples;
  mean += (was - mean) / static_cast<double>(samples);
}

bool GuardedAxis::Evidence::convincing() const {
  return samples >= kGuard.least_explained && unexplained < (1.0 - kGuard.explained) * spread;
}

void GuardedAxis::Evidence::visit(Archive& archive) {
  archive.whole(samples);
  archive.number(mean);
  archive.number(spread);
  archive.number(unexplained);
}

void GuardedAxis::visit(Archive& archive) {
  archive.part("trusted", trusted_);
  archive.flag(guarded_);
  bool doubted = candidate_.has_value();
  archive.flag(doubted);
  if (archive.loading() && doubted) {
    candidate_.emplace(arguments_.make());
  }
  if (candidate_) {
    archive.part("candidate", *candidate_);
    archive.require(candidate_->scaling() != nullptr, "is a candidate without a scale");
  }
  archive.part("first", first_);
  archive.any_number(young_until_);
  archive.part("refused", refused_);
  archive.whole(run_);
  archive.whole(passed_);
  archive.number(run_since_);
  archive.number(share_);
  archive.any_number(before_);
  archive.number(next_look_);
  archive.part("evidence", evidence_);
  bool feeds = feed_.size() > 0;
  archive.flag(feeds);
  if (feeds) {
    if (archive.loading()) {
      feed_ = WarmUp(arguments_.inputs, 2 * ThinnedRows::kMost);
    }
    archive.part("feed", feed_);
  }
  archive.flag(feeds_trusted_);
  archive.whole(implausible_);
  archive.part("begun with", begun_with_);
  archive.part("gone", gone_);
}

}  // namespace kelpie
