// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// Weights of a mixture's members, from their errors on samples they have not learned yet, recent
/// errors first (exponential weights: Cesa-Bianchi & Lugosi 2006).
///
///     share_k ∝ exp(λⁿ π_k − η √s L_k / A),  s = min(1 − λⁿ, 4/3 (1 − λ) A²/Q)
///     L_k ← λₙ L_k + mean loss of block n,  λₙ = min(λ, 1 − 1/n)
///     A ← λₙ A + Σ share_k · mean loss of block n,  Q ← λₙ² Q + (Σ share_k · mean loss)²
///
/// The loss of an error is the square, of an error of at most 10: rare manoeuvres of a calm vehicle
/// count most. Samples that may be garbage are not for score().
/// Division by the mixture's own losses A makes the weights independent of the noise level. The
/// first losses are of members that have learned little: λₙ gives block m of the first blocks a
/// weight in proportion to m, and the exponent grows as √n at first (Cesa-Bianchi & Lugosi 2006,
/// section 2.3), while π_k, the logarithm of the first share, fades. A²/Q is the effective number
/// of blocks (Kish 1965), 3n/4 for n blocks of equal losses: after a change of an accurate model a
/// single block outweighs all others, and tells little of the members. A block consists of kBlock
/// samples, predicted by copies of the members made before the block. (One step ahead, a member
/// with a memory of the last sample would have the largest weight.) Allocates nothing.
class MemberShares {
 public:
  static constexpr std::size_t kMostMembers = 8;
  static constexpr std::size_t kBlock = 20;  ///< samples
  static constexpr std::size_t kMostBlock = 1000;

  /// Begins with these shares, of at most kMostMembers members and with the sum 1.
  explicit MemberShares(std::span<const double> first);

  std::span<const double> shares() const { return {shares_.data(), members_}; }

  /// Adds the errors |y − f_k(x)| of one sample [standardised target]. `block`: samples of the
  /// present block, 1 to kMostBlock.
  void score(std::span<const double> errors, std::size_t block = kBlock);

  /// Whether a block has just ended: the members have to be copied.
  bool block_ended() const { return scored_ == 0; }

  /// Restores shares. Requires a share per member, with the sum 1.
  void resume_from(std::span<const double> shares);

  void start_block();  ///< Discards the present block, after retraining of the members.

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  using Values = std::array<double, kMostMembers>;

  struct Losses {
    Values first{};           ///< π_k
    Values of{};              ///< L_k
    double all = 0.0;         ///< A
    double squares = 0.0;     ///< Q
    std::int64_t blocks = 0;  ///< n
  };

  void learn_block();
  void update_weights();

  std::size_t members_;
  std::size_t scored_ = 0;  ///< samples of the present block
  Values block_{};
  Losses losses_;
  Values shares_{};
};

}  // namespace kelpie
