// SPDX-License-Identifier: Apache-2.0
#include "learner/member_shares.hpp"

#include <algorithm>
#include <cmath>
#include "learner/tuning.hpp"

namespace kelpie {

MemberShares::MemberShares(std::span<const double> first) : members_(first.size()) {
  resume_from(first);
}

void MemberShares::score(std::span<const double> errors, std::size_t block) {
  for (std::size_t k = 0; k < members_; ++k) {
    // What isn't a number is no better than the worst.
    const double error = errors[k] < kOnline.shares.clip ? errors[k] : kOnline.shares.clip;
    block_[k] += error * error;
  }
  if (++scored_ >= block) {
    learn_block();
    update_weights();
    start_block();
  }
}

void MemberShares::learn_block() {
  double all = 0.0;
  for (std::size_t k = 0; k < members_; ++k) {
    block_[k] /= static_cast<double>(scored_);
    all += shares_[k] * block_[k];
  }
  ++losses_.blocks;
  const double keep =
      std::min(kOnline.shares.keep, 1.0 - 1.0 / static_cast<double>(losses_.blocks));
  const double loss = std::max(all, kOnline.shares.least_usual);
  losses_.all = keep * losses_.all + loss;
  losses_.squares = keep * keep * losses_.squares + loss * loss;
  for (std::size_t k = 0; k < members_; ++k) {
    losses_.of[k] = keep * losses_.of[k] + block_[k];
  }
}

void MemberShares::resume_from(std::span<const double> shares) {
  losses_ = {};
  for (std::size_t k = 0; k < members_; ++k) {
    losses_.first[k] = std::log(std::max(shares[k], kOnline.shares.least_share));
  }
  update_weights();
  start_block();
}

void MemberShares::start_block() {
  scored_ = 0;
  block_.fill(0.0);
}

void MemberShares::update_weights() {
  const double before = std::pow(kOnline.shares.keep, losses_.blocks);
  const double least = kOnline.shares.least_usual;
  const double all = std::max(losses_.all, least);
  const double blocks = all * all / std::max(losses_.squares, least * least);
  const double known = std::min(1.0 - before, 4.0 / 3.0 * (1.0 - kOnline.shares.keep) * blocks);
  const double rate = kOnline.shares.learning_rate * std::sqrt(known);
  for (std::size_t k = 0; k < members_; ++k) {
    shares_[k] = before * losses_.first[k] - rate * losses_.of[k] / all;
  }
  const double most = *std::ranges::max_element(std::span(shares_).first(members_));
  double total = 0.0;
  for (std::size_t k = 0; k < members_; ++k) {
    shares_[k] = std::exp(shares_[k] - most);
    total += shares_[k];
  }
  for (std::size_t k = 0; k < members_; ++k) {
    shares_[k] *= 1.0 / total;
  }
}

void MemberShares::visit(Archive& archive) {
  archive.whole(scored_, 0, kMostBlock - 1);
  archive.numbers(std::span(block_).first(members_));
  archive.numbers(std::span(losses_.first).first(members_));
  archive.numbers(std::span(losses_.of).first(members_));
  archive.number(losses_.all);
  archive.number(losses_.squares);
  archive.whole(losses_.blocks);
  if (archive.loading()) {
    update_weights();
  }
}

}  // namespace kelpie
