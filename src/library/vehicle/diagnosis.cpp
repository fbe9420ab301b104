// SPDX-License-Identifier: Apache-2.0
#include "kelpie/vehicle/diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/decomposition.hpp"
#include "core/eigen.hpp"
#include "core/most_value.hpp"
#include "core/normal_equations.hpp"
#include "core/quantile.hpp"
#include "core/roomy_vector.hpp"
#include "core/seconds.hpp"
#include "kelpie/core/scaling.hpp"
#include "vehicle/cause_ranking.hpp"
#include "vehicle/coefficient_monitor.hpp"
#include "vehicle/standstill.hpp"
#include "vehicle/thrust_shares.hpp"
#include "vehicle/tuning.hpp"

namespace kelpie {
namespace {

void visit_finding(Archive& archive, Finding& finding) {
  for (double* const time : {&finding.since_s, &finding.found_s, &finding.told_s}) {
    archive.number(*time);
  }
  archive.choice(finding.state, FindingState::looking, FindingState::none);
  archive.flag(finding.settled);
  archive.whole(finding.count, 0, finding.causes.size());
  for (Cause& cause : finding.causes) {
    visit_cause(archive, cause);
  }
  for (double& share : finding.before) {
    archive.number(share);
  }
  visit_cause(archive, finding.rival);
  for (double* const number : {&finding.evidence, &finding.margin, &finding.explained}) {
    archive.any_number(*number);
  }
}

// φ(x) − φ(0).
Eigen::VectorXd terms_beside_rest(const MotionTerms& terms, std::span<const double> x) {
  Eigen::VectorXd phi(static_cast<Eigen::Index>(terms.size()));
  Eigen::VectorXd rest(phi.size());
  const std::vector<double> zeros(x.size());
  terms.evaluate(x, {phi.data(), terms.size()});
  terms.evaluate(zeros, {rest.data(), terms.size()});
  phi -= rest;
  return phi;
}

}  // namespace

class Diagnosis::State {
 public:
  State(std::size_t inputs, const std::vector<std::size_t>& states,
        std::vector<std::size_t> body_axes, const Attitude& attitude,
        std::span<const std::size_t> others);

  void update(std::span<const double> x, std::span<const double> y, double t);
  void restart();
  const std::vector<Finding>& findings() const { return findings_; }
  std::size_t found() const { return found_; }
  const CoefficientMonitor& monitor() const { return monitor_; }
  const std::vector<Cause>& present() const { return shares_.present(); }
  std::span<const std::size_t> states() const { return monitor_.terms().velocities(); }
  std::span<const std::size_t> body_axes() const { return body_axes_; }
  std::size_t inputs() const { return inputs_; }
  void accelerations(std::span<const double> x, bool nominal, std::span<double> a) const;
  void half_widths(std::span<const double> x, std::span<double> widths) const;
  void visit(Archive& archive);

 private:
  bool moves(std::span<const double> x, double t);
  bool is_outlier(std::span<const double> y);
  bool is_gap(double step_s) const;
  void close_block(double t);
  void start_finding(double t);
  std::span<const double> theta_now() const;
  Eigen::MatrixXd coefficients(bool nominal) const;
  void inspect(double t);
  void report(Finding& finding, const CauseRanking& ranking, double t) const;
  Agreement alone(std::size_t explanation);
  void finish(const CauseRanking& ranking);
  void accept(std::span<const double> delta, double kept);
  void set_delta(const Choice& choice);
  void report_frozen(double t);
  Finding& add_finding(double since, double t);

  CoefficientMonitor monitor_;
  Standstill standstill_;
  NormalEquations block_;
  NormalEquations after_;  // rows since the change under inspection
  double block_start_ = 0.0;
  double since_ = 0.0;         // the block's first row after its last gap
  double row_s_ = 0.0;         // the last row
  bool looking_ = false;       // the last finding is under inspection
  std::size_t guard_ = 0;      // number of blocks still to be skipped
  std::size_t inspected_ = 0;  // number of blocks in after_
  bool outlier_before_ = false;
  std::vector<double> phi_, residual_, delta_, tangent_;
  std::vector<Agreement> alone_;  // of every explanation
  RoomyVector<Finding> findings_;
  std::size_t found_ = 0;
  std::size_t inputs_;
  std::vector<std::size_t> body_axes_;
  ThrustShares shares_;
  ReferenceFit accepted_;        // coefficients of the reference since the last settled change
  std::size_t accepted_at_ = 0;  // number of fits then; 0: no settled change
};

Diagnosis::State::State(std::size_t inputs, const std::vector<std::size_t>& states,
                        std::vector<std::size_t> body_axes, const Attitude& attitude,
                        std::span<const std::size_t> others)
    : monitor_(inputs, states, body_axes, attitude, others),
      standstill_(states),
      block_(monitor_.terms().size(), states.size()),
      after_(block_),
      phi_(monitor_.terms().size()),
      residual_(states.size()),
      delta_(phi_.size() * states.size()),
      tangent_(delta_.size()),
      alone_(monitor_.explanations().list().size()),
      inputs_(inputs),
      body_axes_(std::move(body_axes)),
      shares_(monitor_.terms(), states.size()),
      accepted_(monitor_.terms().size(), states.size()) {
  findings_.reserve(kMostFindings);
}

void Diagnosis::State::update(std::span<const double> x, std::span<const double> y, double t) {
  if (!std::ranges::all_of(x, is_usable) || !std::ranges::all_of(y, is_usable) ||
      !std::isfinite(t) || !moves(x, t)) {
    return;
  }
  monitor_.terms().evaluate(x, phi_);
  if (monitor_.ready() && is_outlier(y)) {
    return;
  }
  if (t < block_start_) {  // a clock set back
    block_.clear();
  }
  if (block_.rows() == 0.0) {
    block_start_ = since_ = t;
  } else if (is_gap(t - row_s_)) {
    since_ = t;  // what changed within the block changed in the gap
  }
  row_s_ = t;
  block_.add(phi_, y);
  if (!looking_ && monitor_.step()) {
    start_finding(t);
  }
  if (block_.rows() >= kDiagnosis.block_rows && t - block_start_ >= kDiagnosis.block_s) {
    close_block(t);
    block_.clear();
  }
}

bool Diagnosis::State::is_gap(double step_s) const {
  const double steps = std::max(1.0, block_.rows() - 1.0);
  return step_s > kDiagnosis.block_s && step_s > kLongestStep * (row_s_ - block_start_) / steps;
}

void Diagnosis::State::restart() {
  if (!looking_) {
    monitor_.restart();
    block_.clear();
  }
}

// A jump that the next row doesn't share.
bool Diagnosis::State::is_outlier(std::span<const double> y) {
  const auto theta = columns_of(monitor_.fit().theta(), phi_.size());
  const auto precision = columns_of(monitor_.fit().precision(), y.size());
  auto residual = as_vector(residual_);
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    residual(i) = y[static_cast<std::size_t>(i)] - theta.col(i).dot(as_vector(phi_));
  }
  double square = 0.0;
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    square += residual(i) * precision.col(i).dot(residual);
  }
  const bool far = square > kDiagnosis.outlier_sigmas * kDiagnosis.outlier_sigmas *
                                static_cast<double>(y.size());
  const bool alone = far && !outlier_before_;
  outlier_before_ = far;
  return alone;
}

// Rows of a sensor that has stopped say nothing of the vehicle.
bool Diagnosis::State::moves(std::span<const double> x, double t) {
  standstill_.update(x, t);
  report_frozen(t);
  return !standstill_.any();
}

// Each sensor once, when it stops; two that stop at once are one finding.
void Diagnosis::State::report_frozen(double t) {
  double earliest = std::numeric_limits<double>::infinity();
  Finding* finding = nullptr;
  for (std::size_t i = 0; i < states().size(); ++i) {
    if (!standstill_.stopped(i)) {
      continue;
    }
    const double since = standstill_.since(i);
    const double value = standstill_.value(i);
    if (finding == nullptr || finding->count == finding->causes.size()) {
      finding = looking_ ? &findings_.back() : &add_finding(since, t);
      looking_ = false;
      finding->state = FindingState::named;
      finding->told_s = t;
      finding->since_s = since;
      finding->settled = true;
      finding->count = 0;
      finding->explained = 1.0;
      finding->before.fill(1.0);
    }
    finding->since_s = std::min(finding->since_s, since);
    finding->causes[finding->count++] = {CauseKind::frozen, standstill_.input(i), value, value,
                                         value};
    earliest = std::min(earliest, since);
  }
  if (finding != nullptr) {
    monitor_.drop_since(earliest);
    shares_.follow({});
    block_.clear();
    guard_ = kDiagnosis.guard_blocks;
  }
}

void Diagnosis::State::close_block(double t) {
  if (guard_ > 0) {
    --guard_;
  } else if (looking_) {
    after_.add(block_);
    ++inspected_;
    inspect(t);
  } else {
    monitor_.insert(block_, block_start_, t, since_);
  }
}

void Diagnosis::State::start_finding(double t) {
  after_.clear();
  const CoefficientMonitor::Cut cut = monitor_.cut(kDiagnosis.guard_blocks, after_);
  add_finding(cut.since_s, t);
  inspected_ = cut.blocks - std::min(kDiagnosis.guard_blocks, cut.blocks);
  guard_ = kDiagnosis.guard_blocks - std::min(kDiagnosis.guard_blocks, cut.blocks);
  looking_ = true;
}

Finding& Diagnosis::State::add_finding(double since, double t) {
  if (findings_.size() == kMostFindings) {
    findings_.erase(findings_.begin());
  }
  ++found_;
  Finding& finding = findings_.emplace_back();
  finding.since_s = since;
  finding.found_s = finding.told_s = t;
  return finding;
}

void Diagnosis::State::inspect(double t) {
  monitor_.compare(after_);
  for (std::size_t i = 0; i < alone_.size(); ++i) {
    alone_[i] = alone(i);
  }
  const CauseRanking ranking =
      rank_causes(monitor_.comparison(), monitor_.explanations().list(), alone_, after_.rows(),
                  monitor_.usual_scatter(), delta_.size());
  if (inspected_ >= kDiagnosis.first_blocks) {
    Finding& finding = findings_.back();
    report(finding, ranking, t);
    const bool is_named = finding.state == FindingState::named;
    shares_.follow(std::span(finding.causes).first(is_named ? finding.count : 0));
  }
  const bool chance =
      ranking.state == FindingState::looking && inspected_ >= kDiagnosis.chance_blocks;
  if (chance || inspected_ >= kDiagnosis.settled_blocks) {
    finish(ranking);
  }
}

// Gauss-Newton steps where the change isn't straight.
Agreement Diagnosis::State::alone(std::size_t explanation) {
  Agreement agreement =
      monitor_.comparison().of(monitor_.explanations().list()[explanation].columns);
  double size = agreement.size[0];
  constexpr int kSteps = 5;
  for (int step = 0; step < kSteps; ++step) {
    if (!monitor_.explanations().curve(monitor_.terms(), explanation, monitor_.fit().theta(), size,
                                       delta_, tangent_)) {
      return agreement;
    }
    const Agreement further = monitor_.comparison().beyond(delta_, tangent_);
    agreement.evidence = further.evidence;
    agreement.size[0] = size;
    agreement.error[0] = further.error[0];
    size += further.size[0];
  }
  return agreement;
}

void Diagnosis::State::report(Finding& finding, const CauseRanking& ranking, double t) const {
  const Choice& best = ranking.best;
  const bool pair = best.other != best.one;
  const auto cause = [&](const Choice& choice, std::size_t explanation, std::size_t column) {
    const CauseKind kind = monitor_.explanations().list()[explanation].kind;
    const bool added = kind == CauseKind::force || kind == CauseKind::sensor_bias;
    const double size = choice.agreement.size[column];
    const double scatter = std::sqrt(ranking.dispersion) * choice.agreement.error[column];
    const double left_out = (added ? kDiagnosis.added_discrepancy : kDiagnosis.discrepancy) * size;
    return shares_.against_nominal(
        monitor_.explanations().cause(explanation, size, kNormal90 * std::hypot(scatter, left_out)),
        monitor_);
  };
  if (finding.state != ranking.state) {
    finding.state = ranking.state;
    finding.told_s = t;
  }
  finding.count = pair ? 2 : 1;
  finding.causes[0] = cause(best, best.one, 0);
  if (pair) {
    finding.causes[1] =
        cause(best, best.other, monitor_.explanations().list()[best.one].columns.size());
  }
  for (std::size_t i = 0; i < finding.count; ++i) {
    const Cause& told = finding.causes[i];
    finding.before[i] = told.kind == CauseKind::thruster ? shares_.settled(told.place) : 1.0;
  }
  finding.rival = cause(ranking.rival, ranking.rival.one, 0);
  finding.evidence = best.agreement.evidence / ranking.dispersion;
  finding.margin = ranking.margin;
  finding.explained = ranking.explained;
}

// From here on the vehicle is taken as it is: what the reference knows stays, but for what has
// changed. Where that isn't known, most of it goes. A finding of which nothing is left after all
// its rows was chance, and is taken back.
void Diagnosis::State::finish(const CauseRanking& ranking) {
  looking_ = false;
  if (ranking.state == FindingState::looking) {
    findings_.pop_back();
    --found_;
    shares_.follow({});
    monitor_.accept_change({}, 1.0, after_);
    return;
  }
  findings_.back().settled = true;
  if (ranking.state == FindingState::named) {
    set_delta(ranking.best);
    accept(delta_, kDiagnosis.kept_named);
  } else {
    accept({}, kDiagnosis.kept_unnamed);
  }
}

// The changed vehicle is the reference: as for CoefficientMonitor::accept_change().
void Diagnosis::State::accept(std::span<const double> delta, double kept) {
  shares_.settle(monitor_.terms(), monitor_.fit().theta(), delta);
  monitor_.accept_change(delta, kept, after_);
  shares_.dead_thrust(monitor_.terms(), delta_);
  monitor_.expect_thrust(delta_);
  accepted_.fit(monitor_.reference());
  accepted_at_ = monitor_.watched();
}

// Until the next fit, a settled change is in the reference alone.
std::span<const double> Diagnosis::State::theta_now() const {
  return accepted_at_ == monitor_.watched() ? accepted_.theta() : monitor_.fit().theta();
}

Eigen::MatrixXd Diagnosis::State::coefficients(bool nominal) const {
  const MotionTerms& terms = monitor_.terms();
  return nominal ? Eigen::MatrixXd(columns_of(shares_.nominal(theta_now()), terms.size()))
                 : shares_.coefficients(terms, theta_now());
}

// θᵀ(φ(x) − φ(0)).
void Diagnosis::State::accelerations(std::span<const double> x, bool nominal,
                                     std::span<double> a) const {
  as_vector(a) = coefficients(nominal).transpose() * terms_beside_rest(monitor_.terms(), x);
}

// Of 90 % intervals, by the rows of the reference and by the present shares.
void Diagnosis::State::half_widths(std::span<const double> x, std::span<double> widths) const {
  const Eigen::VectorXd phi = terms_beside_rest(monitor_.terms(), x);
  const Eigen::MatrixXd inverse = equilibrated_inverse(monitor_.reference().gram());
  const double scatter = phi.dot(inverse * phi) * monitor_.usual_scatter();
  const Eigen::MatrixXd noise =
      kelpie::inverse(columns_of(monitor_.fit().precision(), widths.size()));
  const Eigen::MatrixXd theta = coefficients(true);
  double share_width = 0.0;
  for (const Cause& thruster : present()) {
    share_width += x[thruster.place] != 0.0 ? 0.5 * (thruster.upper - thruster.lower) : 0.0;
  }
  for (std::size_t i = 0; i < widths.size(); ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    const double own = kNormal90 * std::sqrt(std::max(noise(axis, axis) * scatter, 0.0));
    widths[i] = std::hypot(own, share_width * theta.col(axis).dot(phi));
  }
}

// What has changed of the coefficients, into delta_.
void Diagnosis::State::set_delta(const Choice& choice) {
  const Explanations& explanations = monitor_.explanations();
  const bool alone = choice.one == choice.other;
  if (alone && explanations.curve(monitor_.terms(), choice.one, monitor_.fit().theta(),
                                  choice.agreement.size[0], delta_, tangent_)) {
    return;
  }
  std::ranges::fill(delta_, 0.0);
  std::size_t next = 0;
  const auto add = [&](const Explanation& explanation) {
    for (const std::size_t column : explanation.columns) {
      as_vector(delta_) +=
          choice.agreement.size[next++] *
          as_vector(monitor_.directions().subspan(column * delta_.size(), delta_.size()));
    }
  };
  add(explanations.list()[choice.one]);
  if (!alone) {
    add(explanations.list()[choice.other]);
  }
}

void Diagnosis::State::visit(Archive& archive) {
  archive.part("watch", monitor_);
  archive.part("standstill", standstill_);
  archive.part("block", block_);
  archive.part("after", after_);
  for (double* const number : {&block_start_, &since_, &row_s_}) {
    archive.number(*number);
  }
  archive.flag(looking_);
  archive.whole(guard_, 0, kDiagnosis.guard_blocks);
  archive.whole(inspected_);
  archive.flag(outlier_before_);
  archive.whole(found_);
  archive.list(findings_, kMostFindings,
               [&](Finding& finding) { visit_finding(archive, finding); });
  shares_.visit(archive);
  if (archive.loading()) {
    shares_.dead_thrust(monitor_.terms(), delta_);
    monitor_.expect_thrust(delta_);
  }
  archive.part("accepted", accepted_);
  archive.whole(accepted_at_);
  archive.require(!looking_ || !findings_.empty(), "a change looked into that isn't there");
}

Diagnosis::Diagnosis(std::size_t inputs, const std::vector<std::size_t>& states,
                     std::vector<std::size_t> body_axes, const Attitude& attitude,
                     std::span<const std::size_t> others)
    : state_(std::make_unique<State>(inputs, states, std::move(body_axes), attitude, others)) {}

Diagnosis::Diagnosis(const Diagnosis& other) : state_(std::make_unique<State>(*other.state_)) {}
Diagnosis::Diagnosis(Diagnosis&&) noexcept = default;
Diagnosis& Diagnosis::operator=(const Diagnosis& other) {
  return *this = Diagnosis(other);
}
Diagnosis& Diagnosis::operator=(Diagnosis&&) noexcept = default;
Diagnosis::~Diagnosis() = default;

std::size_t Diagnosis::terms(std::size_t inputs, std::span<const std::size_t> states,
                             const Attitude& attitude) {
  return MotionTerms::diagnosis(inputs, states, attitude).size();
}

void Diagnosis::update(std::span<const double> x, std::span<const double> y, double t) {
  state_->update(x, y, t);
}

void Diagnosis::restart() {
  state_->restart();
}

const std::vector<Finding>& Diagnosis::findings() const {
  return state_->findings();
}

std::size_t Diagnosis::found() const {
  return state_->found();
}

const std::vector<Cause>& Diagnosis::health() const {
  return state_->monitor().health();
}

bool Diagnosis::ready() const {
  return state_->monitor().ready();
}

void Diagnosis::thrust(std::size_t input, double command, bool nominal,
                       std::span<double> acceleration, std::span<double> half_width) const {
  std::vector<double> x(state_->inputs());
  x[input] = command;
  state_->accelerations(x, nominal, acceleration);
  if (!half_width.empty()) {
    state_->half_widths(x, half_width);
  }
}

void Diagnosis::accelerations(std::span<const double> x, std::span<double> acceleration) const {
  state_->accelerations(x, false, acceleration);
}

bool Diagnosis::knows_thrust() const {
  return state_->monitor().watched() > 0;
}

std::size_t Diagnosis::inputs() const {
  return state_->inputs();
}

std::span<const std::size_t> Diagnosis::states() const {
  return state_->states();
}

std::span<const std::size_t> Diagnosis::body_axes() const {
  return state_->body_axes();
}

const std::vector<Cause>& Diagnosis::present() const {
  return state_->present();
}

void Diagnosis::visit(Archive& archive) {
  state_->visit(archive);
}

}  // namespace kelpie
