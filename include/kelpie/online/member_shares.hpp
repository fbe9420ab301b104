// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "kelpie/core/archive.hpp"
#include "kelpie/online/calibration_slope.hpp"

namespace kelpie {

/// How much each member of a committee is believed: by its errors on what lay ahead of what it had
/// learned, the latest ones counting most (exponential weights: Cesa-Bianchi & Lugosi 2006).
///
///     share_k ∝ exp(−η L_k / e),  L_k ← λ L_k + mean of its block's errors, each at most 3
///
/// where e is the usual error of all, weighed by their shares: where everybody is nearly right a
/// small difference tells much, and where noise is all there is it tells little. A block is kBlock
/// samples, predicted by members that have learned none of them. (One step ahead, all belief would
/// go to whoever remembers the last sample.) The last member is the mean: of what all together say
/// beyond it, only as much counts as came true (CalibrationSlope), the rest of their shares is its.
/// Allocates nothing.
class MemberShares {
 public:
  static constexpr std::size_t kMostMembers = 8;
  static constexpr std::size_t kBlock = 20;  ///< samples

  explicit MemberShares(std::size_t members);  ///< Requires 0 < members <= kMostMembers.

  std::span<const double> shares() const { return {shares_.data(), members_}; }

  /// Errors |y − f_k(x)| of one sample, in units of the standardised target.
  void score(std::span<const double> errors);

  /// What all together `said` of a sample before it was learned, where the `mean` said that, and
  /// what it `was`.
  void calibrate(double said, double mean, double was);

  /// Whether a block has just ended: members are to be looked at as they are now.
  bool block_ended() const { return scored_ == 0; }

  /// As if earlier errors had given these shares. Requires one per member, adding up to 1.
  void resume_from(std::span<const double> shares);

  /// The members are others now: the block at hand says nothing, and what came true of what the
  /// others said counts half.
  void halve_evidence();

  /// Errors have begun to grow a moment ago: keeps what was believed before the last block.
  void mark_suspicion();

  /// It was a change of the vehicle, which tells nothing about the members: believes what was kept,
  /// where something was.
  void roll_back();

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  using Values = std::array<double, kMostMembers>;

  /// All sums are discounted alike.
  struct Losses {
    Values of{};                                                        ///< L_k
    double all = 0.0;                                                   ///< of all together
    double blocks = 0.0;                                                ///< in it
    CalibrationSlope calibration{};                                     ///< as the block ended
    double usual() const { return blocks > 0.0 ? all / blocks : 1.0; }  ///< e
  };

  void start_block();
  void learn_block();
  void update_weights();

  std::size_t members_;
  std::size_t scored_ = 0;  ///< samples of the block at hand
  Values block_{};
  Losses losses_;
  Losses before_;  ///< the last block
  Losses kept_;    ///< before the suspicion
  CalibrationSlope calibration_;
  double slope_ = 1.0;  ///< that shares_ have
  bool suspicion_marked_ = false;
  Values shares_{};
};

}  // namespace kelpie
