// SPDX-License-Identifier: Apache-2.0
#include "learner/disturbance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/eigen.hpp"
#include "learner/tuning.hpp"

namespace kelpie {
namespace {

constexpr double kLargest = 1e140;  // squares of it and their sums are finite

// A weight per feature, as Eigen computes with them.
template <typename Column>
auto as_column(Column& values) {
  using Of = Eigen::Vector4d;
  return Eigen::Map<std::conditional_t<std::is_const_v<Column>, const Of, Of>>(values.data());
}

}  // namespace

double Disturbance::next(double predicted) const {
  if (!known() || run_ == 0) {
    return 0.0;
  }
  const double y = trusted_target();
  const double trend = 2.0 * y - before_.y;
  const double margin = kOnline.disturbance.around * usual_.value();
  const Column phi = features(predicted);
  const double value = std::clamp(predicted + as_column(theta_).dot(as_column(phi)),
                                  std::min({predicted, y, trend}) - margin,
                                  std::max({predicted, y, trend}) + margin);
  return in_range(predicted, value) - predicted;
}

double Disturbance::ahead(double predicted, double seconds) const {
  if (is_next(seconds)) {
    return next(predicted);
  }
  if (!known()) {
    return 0.0;
  }
  const double faded = std::pow(autocorrelation(), usual_steps(seconds)) * last_error();
  return in_range(predicted, predicted + faded) - predicted;
}

bool Disturbance::is_next(double seconds) const {
  return usual_steps(seconds) <= kOnline.disturbance.next;
}

double Disturbance::autocorrelation() const {
  return information_[0] > 0.0 ? std::clamp(moment_[0] / information_[0], 0.0, 1.0) : 0.0;
}

void Disturbance::observe(double predicted, double y, double t) {
  const double expected = std::clamp(predicted, -kLargest, kLargest);
  const Sample sample{bounded(y, expected), expected};
  const double seconds = t - time_s_;
  const bool follows = run_ > 0 && is_next(seconds);
  if (suspect_) {
    decide_suspect(sample.y, follows);
  }
  if (run_ > 0) {
    score(sample, sample.predicted + ahead(sample.predicted, seconds), follows);
    learn_step(seconds);
  }
  before_ = follows ? last_ : sample;
  last_ = sample;
  time_s_ = t;
  run_ = follows ? run_ + 1 : 1;
}

void Disturbance::visit(Archive& archive) {
  for (auto* values : {&moment_, &theta_, &suspect_phi_}) {
    archive.numbers(*values);
  }
  archive.numbers(information_);
  for (double* value :
       {&energy_, &rows_, &last_.y, &last_.predicted, &before_.y, &before_.predicted, &time_s_,
        &usual_step_s_, &expected_, &trust_, &judged_}) {
    archive.number(*value);
  }
  archive.any_number(low_);
  archive.any_number(high_);
  archive.whole(run_);
  archive.flag(suspect_);
  archive.flag(pending_);
  archive.part("usual errors", usual_);
  archive.part("the model's errors", plain_);
}

double Disturbance::usual_steps(double seconds) const {
  return usual_step_s_ > 0.0 ? seconds / usual_step_s_ : 1.0;
}

// A suspect target counts in part.
double Disturbance::trusted_target() const {
  return suspect_ ? expected_ + trust_ * (last_.y - expected_) : last_.y;
}

Disturbance::Column Disturbance::features(double predicted) const {
  return {last_error(), before_.y - before_.predicted, trusted_target() - before_.y,
          predicted - last_.predicted};
}

double Disturbance::in_range(double predicted, double value) const {
  if (low_ > high_) {
    return value;
  }
  const double margin = kOnline.disturbance.outside * (high_ - low_);
  return std::clamp(value, std::min(predicted, low_ - margin), std::max(predicted, high_ + margin));
}

// Far beyond what was seen and what was predicted, one value is as absurd as another.
double Disturbance::bounded(double y, double predicted) const {
  const double low = std::min(low_, predicted);
  const double high = std::max(high_, predicted);
  const double room = kOnline.disturbance.absurd * (high - low + plain_.value());
  const bool known_range = low_ <= high_ && room > 0.0;
  return std::clamp(y, known_range ? std::max(low - room, -kLargest) : -kLargest,
                    known_range ? std::min(high + room, kLargest) : kLargest);
}

// Whether the last target is to be believed, now that the next one is there.
void Disturbance::decide_suspect(double y, bool follows) {
  const bool confirmed = follows && std::abs(y - last_.y) < std::abs(y - expected_);
  if (follows) {
    judged_ = std::min(judged_ + 1.0, kOnline.disturbance.trust_memory);
    trust_ += ((confirmed ? 1.0 : 0.0) - trust_) / judged_;
  }
  suspect_ = false;
  if (!confirmed) {
    last_.y = expected_;
    return;
  }
  widen_range(last_.y);
  if (pending_) {
    learn(suspect_phi_, last_error());
  }
}

void Disturbance::score(const Sample& sample, double said, bool follows) {
  const double error = sample.y - said;
  const bool learnable = known() && follows && run_ > 1;
  const Column phi = features(sample.predicted);
  suspect_ = known() && std::abs(error) > kOnline.disturbance.far * usual_.value();
  if (suspect_) {
    expected_ = said;
    pending_ = learnable;
    suspect_phi_ = phi;
  } else if (known()) {
    widen_range(sample.y);
    if (learnable) {
      learn(phi, sample.y - sample.predicted);
    }
  }
  if (follows) {
    usual_.add(error);
    plain_.add(sample.y - sample.predicted);
  }
}

void Disturbance::learn(const Column& phi, double error) {
  const auto f = as_column(phi);
  const double square = f.squaredNorm() + error * error;
  const double most = std::pow(kOnline.disturbance.heaviest * plain_.value(), 2);
  const double weight = square > most ? most / square : 1.0;
  const double brought = weight * square;
  if (!(brought > 0.0)) {
    return;
  }
  const double keep = 1.0 - std::min(1.0 - kOnline.disturbance.lambda,
                                     kOnline.disturbance.replaced * brought / energy_);
  energy_ = keep * energy_ + brought;
  rows_ = keep * rows_ + 1.0;
  Eigen::Map<Eigen::Matrix4d> information(information_.data());
  auto moment = as_column(moment_);
  information = keep * information + weight * f * f.transpose();
  moment = keep * moment + weight * error * f;
  Eigen::Matrix4d regular = information;
  regular.diagonal() *= 1.0 + kOnline.disturbance.least_known / rows_;
  const Eigen::Vector4d theta = regular.ldlt().solve(moment);
  as_column(theta_) = theta.allFinite() ? theta : Eigen::Vector4d::Zero();
}

void Disturbance::learn_step(double seconds) {
  if (usual_step_s_ == 0.0) {
    usual_step_s_ = seconds;
  }
  usual_step_s_ +=
      kOnline.disturbance.step_pace *
      (std::min(seconds, kOnline.disturbance.counted_step * usual_step_s_) - usual_step_s_);
}

void Disturbance::widen_range(double y) {
  low_ = std::min(low_, y);
  high_ = std::max(high_, y);
}

}  // namespace kelpie
