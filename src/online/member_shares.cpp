// SPDX-License-Identifier: Apache-2.0
#include "kelpie/online/member_shares.hpp"

#include <algorithm>
#include <cmath>

namespace kelpie {
namespace {

constexpr double kHaste = 0.3;  // η
constexpr double kKeep = 0.98;  // λ: the last 50 blocks have the say
constexpr double kLeastShare = 1e-9;
constexpr double kMostError = 3.0;  // standard deviations that one sample counts

}  // namespace

MemberShares::MemberShares(std::size_t members) : members_(members) {
  believe();
}

void MemberShares::judge(std::span<const double> errors) {
  for (std::size_t k = 0; k < members_; ++k) {
    // What isn't a number is no better than the worst.
    block_[k] += errors[k] < kMostError ? errors[k] : kMostError;
  }
  if (++judged_ == kBlock) {
    for (std::size_t k = 0; k < members_; ++k) {
      loss_[k] = kKeep * loss_[k] + block_[k] / static_cast<double>(kBlock);
    }
    believe();
    restart_block();
  }
}

void MemberShares::go_on_with(std::span<const double> shares) {
  for (std::size_t k = 0; k < members_; ++k) {
    loss_[k] = -std::log(std::max(shares[k], kLeastShare)) / kHaste;
  }
  believe();
  restart_block();
}

void MemberShares::restart_block() {
  judged_ = 0;
  block_.fill(0.0);
}

void MemberShares::believe() {
  const std::span<const double> losses(loss_.data(), members_);
  const double least = *std::ranges::min_element(losses);
  double total = 0.0;
  for (std::size_t k = 0; k < members_; ++k) {
    shares_[k] = std::exp(-kHaste * (losses[k] - least));
    total += shares_[k];
  }
  for (std::size_t k = 0; k < members_; ++k) {
    shares_[k] /= total;
  }
}

void MemberShares::visit(Archive& archive) {
  archive.whole(judged_, 0, kBlock - 1);
  archive.numbers(std::span(block_).first(members_));
  archive.numbers(std::span(loss_).first(members_));
  if (archive.loading()) {
    believe();
  }
}

}  // namespace kelpie
