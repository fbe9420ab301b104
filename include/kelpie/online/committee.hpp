// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "kelpie/online/adaptive_svr.hpp"
#include "kelpie/online/member_shares.hpp"
#include "kelpie/online/relearning.hpp"
#include "kelpie/online/seen_range.hpp"
#include "kelpie/online/sparse_regression.hpp"
#include "kelpie/svr/function_mix.hpp"

namespace kelpie {

/// The learners of one axis, of which nobody knows beforehand who suits the vehicle, on scaled
/// samples. All learn every sample; each is believed by how well it foretold what lay ahead
/// (MemberShares), and none beyond the targets seen (SeenRange).
///
///     learner   the paper's, with the settings given: AdaptiveSvr
///     precise   least squares with a kernel on all samples since the start, for logs with little
///               noise: SparseRegression with up to 300 centres and a small ridge
///     memory    the same for noise: fewer centres, a larger ridge
///     line      the same without a kernel: a straight line through the physics terms
///     mean      of the targets: where nothing can be known nothing is said
///
/// The learner tells when the vehicle has changed, or that it hadn't. Then the others forget what
/// was before, and learn anew the samples that the learner knows of the vehicle now in service:
/// a few with every update, from all over its buffer, and all of them twice, so that the second
/// time it is known which are outliers. `precise` expects a vehicle that is new to be like the one
/// before (SparseRegression::loosen). Nobody is judged until they are done, and shares are as
/// before the change.
///
/// Real time: allocates in the constructor only. An update costs the learner's and O(m²) for m
/// centres and terms. Memory: bytes().
class Committee final : public OnlineRegressor {
 public:
  /// How a committee is made.
  struct Plan {
    bool alone = false;    ///< the learner and nobody else
    std::size_t line = 0;  ///< terms of the line, the first ones
  };

  /// A sample is `inputs` scaled inputs followed by `terms` scaled physics terms. `settings` are
  /// the learner's. Throws InputError on settings that don't validate.
  Committee(std::size_t inputs, std::size_t terms, const OnlineSvrSettings& settings,
            const Plan& plan);

  /// What every update of the learner may spend from now on (AdaptiveSvr::limit). What the others
  /// learn anew has its steps for itself, one per sample; the sample that comes they always learn.
  void limit(const Budget& budget) {
    learner_.limit(budget);
    budget_ = budget;
  }

  Decision update(std::span<const double> z, double y, double t) override;
  void alert(double since_s, bool another) override { learner_.alert(since_s, another); }
  double predict(std::span<const double> z) const override;
  Status status() const override { return learner_.status(); }
  std::vector<MemberShare> members() const override;

  /// predict() and its gradient by z and φ, to rounding; mixed_value_with_gradient()'s conditions.
  double with_gradient(std::span<const double> z, std::span<double> gradient) const;

  /// Copies of what is in service. Allocates.
  FunctionMix function_mix() const;

  /// Brings such copies up to date. Cost O(n inputs). Allocates nothing.
  void refresh(FunctionMix& copies) const;

  /// The weight of a physics term, as FunctionMix::term_weight().
  double term_weight(std::size_t k) const;
  /// Its standard error, likewise in units of the standardised target per scaled term; NaN where
  /// nobody can tell.
  double term_error(std::size_t k) const;

  /// Goes over to another scale, as AdaptiveSvr::rescale(); where that has arrived, all but the
  /// learner begin anew with its buffer. Waits while they still do so since the last change.
  RescaleStatus rescale(const SampleMap& map);

  /// Goes on where a consensus stands: the learners with its support vectors, at the time `t` [s],
  /// the others with what it says there, with its shares and limits. One of a learner alone gives
  /// the learner, and the others learn from it. Requires that nothing has been learned yet, and
  /// functions of such inputs and terms. Allocates.
  void resume_from(const FunctionMix& said, const PastModel::Completion& complete, double t);

  const AdaptiveSvr& learner() const { return learner_; }
  AdaptiveSvr& learner() { return learner_; }  ///< To give it past models.

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Memory in bytes, known before there is one. Requires settings that validate.
  static std::size_t bytes(std::size_t inputs, std::size_t terms, const OnlineSvrSettings& settings,
                           const Plan& plan);

 private:
  static constexpr std::size_t kMembers = 5;
  using WeightedFunctions = std::array<WeightedFunction, kMembers>;

  bool alone() const { return fits_.empty(); }
  const SvrFunction& function(std::size_t member) const;
  std::span<const WeightedFunction> weighted_functions(WeightedFunctions& room) const;
  double short_range_part(std::span<const double> z) const;
  void fit(std::span<const double> z, double y) {
    std::ranges::for_each(fits_, [&](SparseRegression& fit) {
      budget_.charge(fit.work());
      fit.learn(z, y);
    });
  }
  void score(std::span<const double> z, double y);
  void begin_anew(bool from_before, int rounds);
  void learn_slice();
  void freeze_copies() {
    for (std::size_t k = 0; k < kMembers; ++k) {
      frozen_copies_[k] = function(k);
    }
  }
  SampleStore places_of(const SvrFunction& function, const PastModel::Completion& complete);

  AdaptiveSvr learner_;
  std::vector<SparseRegression> fits_;  ///< precise, memory, line, mean; none where it is alone
  std::vector<SvrFunction>
      frozen_copies_;  ///< what each member said at the start of the block at hand
  MemberShares shares_;
  SeenRange seen_;
  Relearning to_learn_;         ///< the others, with the learner's buffer
  std::vector<double> sample_;  ///< scratch
  Budget budget_;               ///< of every update
};

}  // namespace kelpie
