// SPDX-License-Identifier: Apache-2.0
#include "model/guarded_axis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "model/tuning.hpp"
#include "svr/valid_sample.hpp"

namespace kelpie {
namespace {

constexpr const auto& kGuard = kModelTuning.guard;
constexpr double kNever = std::numeric_limits<double>::infinity();

// Mean and variance of one column.
struct Column {
  double mean = 0.0;
  double scatter = 0.0;
  double samples = 0.0;
  double largest = 0.0;  // magnitude, in scaled units
  void add(double value, double zero) {
    samples += 1.0;
    largest = std::max(largest, std::abs(value - zero));
    const double before = value - mean;
    mean += before / samples;
    scatter += before * (value - mean);
  }
  double deviation() const { return std::sqrt(scatter / samples); }
};

// Scaled inputs and target of the later half.
using Columns = std::array<Column, kMostInputs + 1>;

double scaled_value(const AxisScaling& scaling, const ScaledInput& z, double y, std::size_t k) {
  return k < scaling.input.dimension() ? as_span(z)[k] : scaling.target.apply(y);
}

Columns later_half(const AxisScaling& scaling, const ThinnedRows& rows) {
  Columns columns{};
  const std::array<double, kMostInputs> zeros{};
  const std::size_t inputs = scaling.input.dimension();
  const ScaledInput zero = scaling.input.apply(std::span(zeros).first(inputs));
  for (std::size_t i = rows.size() / 2; i < rows.size(); ++i) {
    const ScaledInput z = scaling.input.apply(rows[i].x);
    for (std::size_t k = 0; k <= inputs; ++k) {
      columns[k].add(scaled_value(scaling, z, rows[i].y, k), scaled_value(scaling, zero, 0.0, k));
    }
  }
  return columns;
}

// Whether the later half stays within a small part of the scale: in the target, or in an input.
// Constant columns tell nothing, nor does a command that is held at a value like those before.
bool tiny_in(const AxisScaling& scaling, const ThinnedRows& rows) {
  const Columns columns = later_half(scaling, rows);
  return std::ranges::any_of(columns, [](const Column& column) {
    return column.scatter > 0.0 && column.deviation() < kGuard.tiny &&
           column.largest < kGuard.near_zero;
  });
}

// The first of the latest samples that are alike.
std::size_t first_alike(const AxisScaling& scaling, const ThinnedRows& rows) {
  const Columns columns = later_half(scaling, rows);
  std::size_t first = rows.size() / 2;
  const auto alike = [&](const WarmUp::Sample& row) {
    const ScaledInput z = scaling.input.apply(row.x);
    for (std::size_t k = 0; k <= scaling.input.dimension(); ++k) {
      const double away = scaled_value(scaling, z, row.y, k) - columns[k].mean;
      if (columns[k].scatter > 0.0 && std::abs(away) > kGuard.alike * columns[k].deviation()) {
        return false;
      }
    }
    return true;
  };
  while (first > 0 && alike(rows[first - 1])) {
    --first;
  }
  return first;
}

}  // namespace

GuardedAxis::GuardedAxis(std::size_t inputs, const SharedSettings& shared,
                         const OnlineSvrSettings& settings, const TermSet& terms,
                         std::optional<AxisScaling> scaling)
    : arguments_{inputs, shared, settings, terms, std::move(scaling)},
      axes_{arguments_.make(), arguments_.make_early()},
      other_(shared.track > 0.0 && !arguments_.scaling ? Other::early : Other::none),
      candidate_serves_(other_ == Other::early),
      expected_target_(terms),
      guarded_(shared.track > 0.0),
      first_(inputs),
      young_until_(arguments_.scaling ? -kNever : kNever),
      held_from_(-kNever),
      refused_(inputs),
      before_(-kNever),
      feed_(inputs, 2 * ThinnedRows::kMost) {}

DynamicsAxis GuardedAxis::Arguments::make_early() const {
  SharedSettings early = shared;
  early.warmup = std::min(early.warmup, kGuard.early_samples);
  return {inputs, early, settings, terms, scaling};
}

void GuardedAxis::limit(const Budget& budget) {
  std::ranges::for_each(axes_, [&](DynamicsAxis& axis) { axis.limit(budget); });
}

void GuardedAxis::alert(double since_s, bool another) {
  trusted().alert(since_s, another);
}

void GuardedAxis::apply_change(std::span<const CommandGain> gains, std::span<const double> step,
                               const Decision& news) {
  trusted().apply_change(gains, step, news);
  if (on_probation() || other_ == Other::former) {
    candidate().apply_change(gains, step, news);
    begun_with_.changes += news.changed ? 1 : 0;  // one change of the vehicle, in both tallies
    begun_with_.withdrawn += news.withdrawn ? 1 : 0;
  }
}

void GuardedAxis::expect_vehicle(std::vector<double> coefficients) {
  expected_ = std::move(coefficients);
  trusted().expect_vehicle(expected_);
  if (other_ == Other::early) {
    candidate().expect_vehicle(expected_);
  }
}

void GuardedAxis::resume_from(const Snapshot& trained, double t) {
  trusted().resume_from(trained.scaling, trained.function, t);
  candidate() = trusted();
  other_ = Other::none;
  candidate_serves_ = false;
  young_until_ = -kNever;
}

void GuardedAxis::learn_held_back() {
  while (feed_.size() > 0) {
    feed();
  }
  trusted().learn_held_back();
  end_early();
}

// The way of a sample through the guard (docs/reference/architecture.md).
Decision GuardedAxis::update(std::span<const double> x, double y, double t) {
  trusted_last_ = true;
  if (!guarded_ || !valid_sample(x, arguments_.inputs, y, t)) {
    return trusted().update(x, y, t);
  }
  const bool refused = doubtful(x, y, t);
  if (trusted().scaling() != nullptr && !trusted().far(x)) {
    expected_target_.learn(x, y, refused);
  }
  count_time(refused, t);
  const bool another_serves = refused != candidate_serves_;  // than the axis that learns
  const Prediction said = refused || another_serves ? assess(x) : Prediction{};
  const bool had_model = another_serves && in_service().status().ready;
  const bool early = other_ == Other::early;
  Decision decision = refused ? learn_doubted(x, y, t, said) : learn_trusted(x, y, t);
  if (another_serves) {
    decision.prediction = said;
    decision.had_model = had_model;
  }
  decision.early = early && decision.had_model;
  feed();
  look(t);
  candidate_serves_ = other_ == Other::early ||
                      (on_probation() && trusted().scaling() != nullptr && trusted().far(x));
  return decision;
}

// In the first half minute nothing has been held for long.
bool GuardedAxis::plausible(std::span<const double> x, double y, double t) const {
  return trusted().plausible(x, y) && (t >= held_from_ || !trusted().far(x));
}

bool GuardedAxis::expected(std::span<const double> x, double y) const {
  return !trusted().far(x) && expected_target_.expects(x, y, trusted().scaling()->target.mean);
}

// An implausible sample, or one among implausible samples.
bool GuardedAxis::doubtful(std::span<const double> x, double y, double t) {
  const bool implausible = trusted().scaling() != nullptr && !plausible(x, y, t);
  if (implausible && recent_ <= kGuard.company && other_ != Other::former_on_trial) {
    evidence_.begin_stretch();
  }
  recent_ += kGuard.recent * ((implausible ? 1.0 : 0.0) - recent_);
  return implausible ? !expected(x, y) : recent_ > kGuard.company;
}

void GuardedAxis::count_time(bool refused, double t) {
  if (young_until_ == kNever) {
    young_until_ = t + kGuard.young_s;
    held_from_ = t + kGuard.held_s;
    next_look_ = t + kGuard.look_s;
  }
  const double kept = std::exp(-(t - std::max(before_, t - kGuard.look_s)) / kGuard.share_s);
  share_ = kept * share_ + (refused ? 1.0 - kept : 0.0);
  before_ = t;
}

Decision GuardedAxis::learn_trusted(std::span<const double> x, double y, double t) {
  if (++passed_ > run_) {
    run_ = 0;
    if (!on_probation()) {
      refused_.clear();
    }
  }
  if (t <= young_until_) {
    first_.add(x, y, t);
  }
  if (feeds_trusted_ && feed_.size() > 0) {  // behind the samples of the new axis
    feed_.hold(x, y, t);
    return {.verdict = Verdict::held_back,
            .prediction = {.value = trusted().predict(x)},
            .had_model = trusted().status().ready};
  }
  const Decision decision = trusted().update(x, y, t);
  end_early();
  if (other_ == Other::early) {
    candidate().update(x, y, t);
  }
  return decision;
}

// Once the trusted axis has learned the samples that were held back.
void GuardedAxis::end_early() {
  if (other_ == Other::early && !trusted().holds_back()) {
    other_ = Other::none;
    candidate_serves_ = false;
    candidate() = trusted();  // allocates now what a candidate needs
  }
}

Decision GuardedAxis::learn_doubted(std::span<const double> x, double y, double t,
                                    const Prediction& said) {
  trusted_last_ = false;
  if (other_ == Other::candidate && !feeds_trusted_ && t - doubted_s_ > kGuard.stale_s) {
    renew_candidate(t);
  }
  doubted_s_ = t;
  if (other_ == Other::former_on_trial && run_ == 0) {
    refused_.clear();  // those before are learned
  }
  refused_.add(x, y, t);
  Decision decision{.verdict = Verdict::held_back,
                    .prediction = said,
                    .had_model = in_service().status().ready,
                    .kkt_gap = in_service().status().kkt_gap};
  const bool fed = on_probation() && !feeds_trusted_;
  if (fed && (feed_.size() > 0 || candidate().awaits_scale())) {
    feed_.hold(x, y, t);
  } else if (on_probation() &&
             (candidate().changes_scale() || arguments_.scaling || candidate().plausible(x, y))) {
    decision = learn_in_candidate(x, y, t);
  } else {
    decision.verdict = Verdict::implausible;
    ++implausible_;
    doubt(t);
  }
  return decision;
}

Decision GuardedAxis::learn_in_candidate(std::span<const double> x, double y, double t) {
  if (!plausible(x, y, t)) {  // a sample in such company tells nothing
    evidence_.add(candidate().predict(x), y, candidate().scaling()->target.scale);
  }
  Decision decision = candidate().update(x, y, t);
  // What a candidate on probation finds is no news of the vehicle.
  decision.suspected = decision.changed = decision.withdrawn = decision.returning = false;
  decision.recalled = 0;
  if (share_ > kGuard.confirmed_share || (evidence_.convincing() && t >= convincing_from_)) {
    trust_candidate(t);
  } else if (other_ == Other::former_on_trial && evidence_.rejects()) {
    renew_candidate(t);
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
  if (run_ < kGuard.least_refused || t - run_since_ < kGuard.believed_s) {
    return;
  }
  if (!on_probation()) {
    begin_candidate(t);
  } else if (!feeds_trusted_) {  // out of the candidate's scale, too: the candidate follows
    run_ = 0;
    teach_refused(run_since_);
  }
}

void GuardedAxis::begin_probation(Other other, double t) {
  other_ = other;
  evidence_ = {};
  convincing_from_ = t + kGuard.convinced_s;
  doubted_s_ = t;
  run_ = 0;
  feed_.drop_oldest(feed_.size());
}

void GuardedAxis::begin_candidate(double t) {
  drop_candidate();
  begin_probation(Other::candidate, t);
  candidate() = trusted();
  begun_with_ = trusted().status().tally;
  next_look_ = t + kGuard.look_s;
  feeds_trusted_ = false;
  teach_refused(-kNever);
}

void GuardedAxis::teach_refused(double since_s) {
  std::size_t first = 0;
  while (first < refused_.size() && refused_[first].t < since_s) {
    ++first;
  }
  candidate().expect(refused_, first);
  for (std::size_t i = first; i < refused_.size(); ++i) {
    feed_.hold(refused_[i].x, refused_[i].y, refused_[i].t);
  }
}

void GuardedAxis::renew_candidate(double t) {
  if (refused_.size() == 0) {
    drop_candidate();
    return;
  }
  const double convincing_from = convincing_from_;
  const Evidence evidence = evidence_;
  begin_candidate(t);
  convincing_from_ = convincing_from;
  evidence_ = evidence;
}

void GuardedAxis::drop_candidate() {
  if (on_probation()) {
    gone_.add(candidate().status().tally);
    gone_.subtract(begun_with_);
    other_ = Other::none;
  }
}

void GuardedAxis::trust_candidate(double t) {
  gone_.add(trusted().status().tally);
  gone_.subtract(begun_with_);
  trusted_ = 1 - trusted_;
  other_ = t > young_until_ ? Other::former : Other::none;
  guarded_ = !arguments_.scaling;
  if (other_ == Other::former) {
    first_.clear();  // what comes from now on tells whether the former axis was right
  } else {
    std::swap(first_, refused_);
  }
  refused_.clear();
  run_ = 0;
  recent_ = 0.0;
  share_ = 0.0;
  // A scale in which samples out of another are explained is none of garbage.
  young_until_ = evidence_.convincing() ? t : t + kGuard.confirmed_young_s;
  next_look_ = t + kGuard.look_s;
}

// With the later half of the first samples. The former axis may still be right, as of a vehicle
// that moved first and then hardly: it is the candidate until it has explained, or not, the next
// samples out of the new scale.
void GuardedAxis::begin_anew(double t) {
  const std::size_t first = first_alike(*trusted().scaling(), first_);
  if (other_ == Other::former_on_trial) {
    gone_.add(trusted().status().tally);
  } else {
    drop_candidate();
    trusted_ = 1 - trusted_;
    begun_with_ = {};
  }
  begin_probation(Other::former_on_trial, t);
  expected_target_.clear();
  trusted() = arguments_.make();
  trusted().set_past_models(given_);
  trusted().expect_vehicle(expected_);
  const std::size_t warm =
      std::min(first + static_cast<std::size_t>(arguments_.shared.warmup), first_.size());
  for (std::size_t i = first; i < warm; ++i) {
    trusted().update(first_[i].x, first_[i].y, first_[i].t);
  }
  feed_trusted(warm);
  first_.drop_oldest(first);
}

// The candidate took over too early.
void GuardedAxis::return_to_former(double t) {
  trusted_ = 1 - trusted_;
  gone_.add(begun_with_);
  gone_.subtract(trusted().status().tally);
  begin_probation(Other::former_on_trial, t);
  young_until_ = t;
  feed_trusted(first_alike(*candidate().scaling(), first_));
  first_.clear();
}

void GuardedAxis::feed_trusted(std::size_t first) {
  recent_ = 0.0;
  share_ = 0.0;
  refused_.clear();
  feeds_trusted_ = true;
  for (std::size_t i = first; i < first_.size(); ++i) {
    feed_.hold(first_[i].x, first_[i].y, first_[i].t);
  }
}

void GuardedAxis::feed() {
  DynamicsAxis& learner = feeds_trusted_ ? trusted() : candidate();
  const auto waits = [&] { return !feeds_trusted_ && learner.awaits_scale(); };
  for (std::size_t k = 0; k < kGuard.slices && feed_.size() > 0 && waits(); ++k) {
    learner.change_scale();
  }
  for (std::size_t k = 0; k < kGuard.per_update && feed_.size() > 0 && !waits(); ++k) {
    const WarmUp::Sample row = feed_[0];
    if (!feeds_trusted_ || trusted().scaling() == nullptr || plausible(row.x, row.y, row.t)) {
      learner.update(row.x, row.y, row.t);
    }
    feed_.drop_oldest(1);
  }
  feeds_trusted_ = feeds_trusted_ && feed_.size() > 0;
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
  } else if (too_large(trusted(), first_)) {
    other_ == Other::former ? return_to_former(t) : begin_anew(t);
    return;
  }
  if (other_ == Other::candidate && too_large(candidate(), refused_)) {
    refused_.drop_oldest(first_alike(*candidate().scaling(), refused_));
    begin_candidate(t);
  }
}

// A slow vehicle may stay in a small part of its scale; an axis in a scale of garbage explains
// nothing besides.
bool GuardedAxis::too_large(const DynamicsAxis& axis, const ThinnedRows& rows) {
  const std::size_t half = rows.size() / 2;
  const std::size_t samples = rows.size() - half;
  if (axis.scaling() == nullptr || samples < kGuard.least_half || !tiny_in(*axis.scaling(), rows)) {
    return false;
  }
  const std::size_t probes = std::min(samples, kGuard.probes);
  double mean = 0.0;
  for (std::size_t k = 0; k < probes; ++k) {
    mean += rows[half + k * samples / probes].y / static_cast<double>(probes);
  }
  double spread = 0.0;
  double unexplained = 0.0;
  for (std::size_t k = 0; k < probes; ++k) {
    const WarmUp::Sample row = rows[half + k * samples / probes];
    spread += std::abs(row.y - mean);
    unexplained += std::abs(row.y - axis.predict(row.x));
  }
  return unexplained > kGuard.unexplained * spread;
}

Status GuardedAxis::status() const {
  Status status = in_service().status();
  status.early = other_ == Other::early && status.ready;
  status.tally = trusted().status().tally;
  status.tally.add(gone_);
  if (on_probation()) {
    status.tally.add(candidate().status().tally);
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
  if (of_stretch > 0.0) {
    spread += clipped(was - mean);
    unexplained += clipped(was - said);
  }
  samples += 1.0;
  of_stretch += 1.0;
  mean += (was - mean) / of_stretch;
}

void GuardedAxis::Evidence::begin_stretch() {
  of_stretch = mean = 0.0;
}

bool GuardedAxis::Evidence::convincing() const {
  return samples >= kGuard.least_explained && moves() &&
         unexplained < (1.0 - kGuard.explained) * spread;
}

bool GuardedAxis::Evidence::rejects() const {
  if (unexplained > kGuard.worse * spread) {  // too large a scale tells no movement
    return samples >= kGuard.least_explained;
  }
  const bool nothing = unexplained > kGuard.unexplained * spread;
  return moves() && samples >= (nothing ? kGuard.least_explained : kGuard.least_rejected);
}

bool GuardedAxis::Evidence::moves() const {
  return spread > kGuard.moving * kGuard.moving * samples;
}

void GuardedAxis::Evidence::visit(Archive& archive) {
  archive.number(samples);
  archive.number(of_stretch);
  archive.number(mean);
  archive.number(spread);
  archive.number(unexplained);
}

void GuardedAxis::visit(Archive& archive) {
  archive.list(expected_, arguments_.terms.size() + 1, [&](double& one) { archive.number(one); });
  archive.whole(trusted_, 0, 1);
  archive.part("trusted", trusted());
  archive.choice(other_, Other{}, Other::former_on_trial);
  if (other_ != Other::none) {
    archive.part("candidate", candidate());
    archive.require(other_ == Other::early || candidate().scaling() != nullptr,
                    "is a candidate without a scale");
  } else if (archive.loading()) {
    candidate() = trusted();
  }
  archive.flag(candidate_serves_);
  archive.require(other_ == Other::early || on_probation() || !candidate_serves_,
                  "serves without a candidate");
  archive.part("expected target", expected_target_);
  archive.flag(guarded_);
  archive.part("first", first_);
  archive.any_number(young_until_);
  archive.any_number(held_from_);
  archive.part("refused", refused_);
  archive.whole(run_);
  archive.whole(passed_);
  archive.number(run_since_);
  archive.number(doubted_s_);
  archive.number(recent_);
  archive.number(share_);
  archive.any_number(before_);
  archive.number(next_look_);
  archive.part("evidence", evidence_);
  archive.number(convincing_from_);
  archive.part("feed", feed_);
  archive.flag(feeds_trusted_);
  archive.whole(implausible_);
  archive.part("begun with", begun_with_);
  archive.part("gone", gone_);
}

}  // namespace kelpie
