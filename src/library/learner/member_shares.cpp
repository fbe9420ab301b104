// SPDX-License-Identifier: Apache-2.0
#include "learner/member_shares.hpp"

#include <algorithm>
#include <cmath>
#include "learner/tuning.hpp"

namespace kelpie {

MemberShares::MemberShares(std::span<const double> first) : members_(first.size()) {
  resume_from(first);
}

void MemberShares::score(std::span<const double> errors) {
  for (std::size_t k = 0; k < members_; ++k) {
    // What isn't a number is no better than the worst.
    const double error = errors[k] < kOnline.shares.clip ? errors[k] : kOnline.shares.clip;
    block_[k] += error * std::sqrt(error);
  }
  if (++scored_ == kBlock) {
    learn_block();
    update_weights();
    start_block();
  }
}

void MemberShares::calibrate(double said, double mean, double was) {
  calibration_.add((said - mean) / slope_, was - mean);
}

void MemberShares::learn_block() {
  double all = 0.0;
  for (std::size_t k = 0; k < members_; ++k) {
    block_[k] /= static_cast<double>(kBlock);
    all += shares_[k] * block_[k];
  }
  losses_.all = kOnline.shares.keep * losses_.all + std::max(all, kOnline.shares.least_usual);
  losses_.blocks = kOnline.shares.keep * losses_.blocks + 1.0;
  losses_.calibration = calibration_;
  for (std::size_t k = 0; k < members_; ++k) {
    losses_.first[k] *= kOnline.shares.keep;
    losses_.of[k] = kOnline.shares.keep * losses_.of[k] + block_[k];
  }
}

void MemberShares::resume_from(std::span<const double> shares) {
  losses_ = {};
  calibration_ = {};
  for (std::size_t k = 0; k < members_; ++k) {
    losses_.first[k] = std::log(std::max(shares[k], kOnline.shares.least_share));
  }
  update_weights();
  start_block();
}

void MemberShares::halve_evidence() {
  calibration_.halve();
  losses_.calibration = calibration_;
  update_weights();
  start_block();
}

void MemberShares::start_block() {
  scored_ = 0;
  block_.fill(0.0);
}

void MemberShares::update_weights() {
  slope_ = losses_.calibration.value();
  for (std::size_t k = 0; k < members_; ++k) {
    shares_[k] = losses_.first[k] - kOnline.shares.learning_rate * losses_.of[k] / losses_.usual();
  }
  const double most = *std::ranges::max_element(std::span(shares_).first(members_));
  double total = 0.0;
  for (std::size_t k = 0; k < members_; ++k) {
    shares_[k] = std::exp(shares_[k] - most);
    total += shares_[k];
  }
  for (std::size_t k = 0; k < members_; ++k) {
    shares_[k] *= slope_ / total;
  }
  shares_[members_ - 1] += 1.0 - slope_;
}

void MemberShares::visit(Archive& archive) {
  archive.whole(scored_, 0, kBlock - 1);
  archive.numbers(std::span(block_).first(members_));
  archive.numbers(std::span(losses_.first).first(members_));
  archive.numbers(std::span(losses_.of).first(members_));
  archive.number(losses_.all);
  archive.number(losses_.blocks);
  archive.part("calibration at the block", losses_.calibration);
  archive.part("calibration", calibration_);
  if (archive.loading()) {
    update_weights();
  }
}

}  // namespace kelpie
