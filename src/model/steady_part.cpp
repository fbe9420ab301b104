// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/steady_part.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kelpie {
namespace {

constexpr double kPrior = 0.1;        // as of a tenth of a sample per coefficient
constexpr double kLongestStep = 3.0;  // usual steps
constexpr double kJump = 4.0;         // usual accelerations, beyond what was measured
constexpr double kMemory = 1000.0;    // samples over which steps and errors are averaged
constexpr double kMostCorrelated = 0.999;

// A mean over the last kMemory values, over all as long as there are fewer.
void average(double& mean, double value, std::int64_t count) {
  mean += (value - mean) / std::min(static_cast<double>(count), kMemory);
}

}  // namespace

double SteadyModel::acceleration(std::span<const double> phi) const {
  const auto size = static_cast<Eigen::Index>(phi.size());
  return Eigen::Map<const Eigen::VectorXd>(weights.data(), size)
             .dot(Eigen::Map<const Eigen::VectorXd>(phi.data(), size)) +
         weights.back();
}

SteadyPart::SteadyPart(TermSet terms, std::size_t inputs, std::size_t state)
    : terms_(std::move(terms)),
      state_(state),
      seen_(inputs),
      fit_(static_cast<Eigen::Index>(terms_.size()) + 1, kPrior),
      phi_(Eigen::VectorXd::Ones(fit_.terms())),
      next_(phi_) {}

void SteadyPart::observe(std::span<const double> x, double y, double t) {
  terms_.evaluate(x, {next_.data(), terms_.size()});
  if (fit_.rows() >= kLeastSteps) {
    learn_error(y - fit_.theta().dot(next_));
  }
  const double step_s = t - time_s_;
  if (samples_ > 0 && step_s > 0.0) {
    learn_step(x[state_] - velocity_, y, step_s);
  }
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    Extremes& range = seen_[i];
    range = samples_ > 0 ? Extremes{std::min(range.low, x[i]), std::max(range.high, x[i])}
                         : Extremes{x[i], x[i]};
  }
  average(target_square_, y * y, ++samples_);
  phi_ = next_;
  velocity_ = x[state_];
  target_ = y;
  time_s_ = t;
}

void SteadyPart::learn_step(double change, double y, double step_s) {
  if (usual_step_s_ == 0.0) {
    usual_step_s_ = step_s;
  }
  const double longest = kLongestStep * usual_step_s_;
  average(usual_step_s_, std::min(step_s, longest), samples_);
  const double jump = change / step_s - 0.5 * (target_ + y);
  if (step_s <= longest && jump * jump <= kJump * kJump * target_square_) {
    phi_ = 0.5 * (phi_ + next_);
    fit_.add(phi_, change / step_s);
  }
}

void SteadyPart::learn_error(double error) {
  average(error_square_, error * error, ++errors_);
  average(error_product_, error * last_error_, errors_);
  last_error_ = error;
}

void SteadyPart::restart() {
  fit_.clear();
  samples_ = 0;
  errors_ = 0;
  last_error_ = 0.0;
}

void SteadyPart::visit(Archive& archive) {
  for (Extremes& range : seen_) {
    archive.number(range.low);
    archive.number(range.high);
  }
  archive.part("fit", fit_);
  archive.numbers({phi_.data(), static_cast<std::size_t>(phi_.size())});
  for (double* number : {&velocity_, &target_, &time_s_, &usual_step_s_, &target_square_,
                         &error_square_, &error_product_, &last_error_}) {
    archive.number(*number);
  }
  archive.whole(errors_);
  archive.whole(samples_);
}

SteadyModel SteadyPart::model() const {
  SteadyModel model;
  model.state = state_;
  if (fit_.rows() >= kLeastSteps && errors_ > 0) {
    model.weights.assign(fit_.theta().begin(), fit_.theta().end());
    model.seen = seen_;
    model.error = std::sqrt(error_square_);
    const double correlation = error_square_ > 0.0 ? error_product_ / error_square_ : 0.0;
    model.error_time_s =
        correlation > 0.0 ? -usual_step_s_ / std::log(std::min(correlation, kMostCorrelated)) : 0.0;
  }
  return model;
}

}  // namespace kelpie
