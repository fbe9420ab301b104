// SPDX-License-Identifier: Apache-2.0
#include "learner/conformal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include "learner/tuning.hpp"

namespace kelpie {
namespace {

// The η that the paper derives for losses of stationary errors, section 3.
double learning_rate(double miss, double experts) {
  const double cover = 1.0 - miss;
  const double loss = cover * cover * std::pow(miss, 3) + miss * miss * std::pow(cover, 3);
  return std::sqrt(3.0 / kOnline.interval.stretch) *
         std::sqrt((std::log(experts * kOnline.interval.stretch) + 2.0) / loss);
}

}  // namespace

ConformalInterval::ConformalInterval(double coverage)
    : miss_(1.0 - coverage),
      learning_rate_(learning_rate(miss_, static_cast<double>(kPaces.size()))),
      half_width_(std::numeric_limits<double>::infinity()) {
  alpha_.fill(miss_);
  weight_.fill(1.0 / static_cast<double>(kPaces.size()));
}

std::size_t ConformalInterval::least() const {
  return std::max(kOnline.interval.min_errors,
                  static_cast<std::size_t>(std::ceil((1.0 - miss_) / miss_)));
}

void ConformalInterval::observe(double error) {
  if (std::isnan(error)) {
    return;
  }
  if (size_ >= least()) {
    update_level(level_of(error));
  }
  keep(error);
  if (size_ >= least()) {
    half_width_ = quantile_now();
  }
}

void ConformalInterval::visit(Archive& archive) {
  archive.numbers(alpha_);
  archive.numbers(weight_);
  archive.whole(size_, 0, kWindow);
  archive.whole(next_, 0, kWindow - 1);
  archive.require(size_ == kWindow || next_ == size_, "has errors in the wrong places");
  archive.numbers(std::span(recent_).first(size_));
  if (archive.loading()) {
    std::ranges::copy(std::span(recent_).first(size_), sorted_.begin());
    std::ranges::sort(std::span(sorted_).first(size_));
    half_width_ = size_ >= least() ? quantile_now() : std::numeric_limits<double>::infinity();
  }
}

// β of the paper: the highest level whose interval would have held the error; 0 where even the
// largest error of the window is smaller.
double ConformalInterval::level_of(double error) const {
  const auto not_less = sorted().end() - std::ranges::lower_bound(sorted(), error);
  return not_less == 0 ? 0.0 : static_cast<double>(not_less + 1) / static_cast<double>(size_ + 1);
}

// Algorithm 1 of the paper, with σ = 1 / (2 kOnline.interval.stretch).
void ConformalInterval::update_level(double level) {
  constexpr double kShare = 0.5 / kOnline.interval.stretch;
  double total = 0.0;
  for (std::size_t i = 0; i < kPaces.size(); ++i) {
    const double off = level - alpha_[i];
    const double loss = miss_ * off - std::min(0.0, off);
    weight_[i] *= std::exp(-learning_rate_ * loss);
    total += weight_[i];
    alpha_[i] += kPaces[i] * (miss_ - (off < 0.0 ? 1.0 : 0.0));
  }
  for (double& weight : weight_) {
    weight = (1.0 - kShare) * weight / total + kShare / static_cast<double>(kPaces.size());
  }
}

void ConformalInterval::keep(double error) {
  double* end = sorted_.data() + size_;
  if (size_ == kWindow) {
    double* const oldest = std::lower_bound(sorted_.data(), end, recent_[next_]);
    std::copy(oldest + 1, end, oldest);
    --end;
  } else {
    ++size_;
  }
  double* const place = std::upper_bound(sorted_.data(), end, error);
  std::copy_backward(place, end, end + 1);
  *place = error;
  recent_[next_] = error;
  next_ = (next_ + 1) % kWindow;
}

double ConformalInterval::quantile_now() const {
  const double level = std::inner_product(weight_.begin(), weight_.end(), alpha_.begin(), 0.0);
  const auto places = static_cast<double>(size_ + 1);
  const double rank = std::ceil((1.0 - level) * places);
  return sorted_[static_cast<std::size_t>(std::clamp(rank, 1.0, places - 1.0)) - 1];
}

}  // namespace kelpie
