// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "learner/adaptive_svr.hpp"
#include "learner/member_shares.hpp"
#include "learner/relearning.hpp"
#include "learner/seen_range.hpp"
#include "learner/sparse_regression.hpp"
#include "svr/function_mix.hpp"

namespace kelpie {

struct LearnerState;

/// The models of one axis, on scaled samples, combined into a weighted mean. Every member learns
/// every sample. MemberShares weights the members by their prediction errors. SeenRange limits the
/// value of each member to the range of the targets seen, and every physics term to twice the range
/// of the term seen.
///
///     learner   the paper's learner with the settings given: AdaptiveSvr
///     precise   kernel least squares over all samples since the start, for logs with little
///               noise: SparseRegression with up to 300 centres and a small ridge
///     memory    the same for noisy logs: fewer centres and a larger ridge
///     physics   the same without a kernel: linear in all physics terms
///     line      the same in x, x|x| and the products of velocities alone
///     mean      the mean of the targets, for axes without predictable structure
///
/// The learner reports a change of the vehicle or the withdrawal of a change. The other members
/// then forget everything and relearn the learner's buffer (Relearning), a few samples per update
/// and two rounds in all, since the second round knows the outliers from its start. After a change
/// to an unknown vehicle `precise` keeps its estimate as a weak prior (SparseRegression::weaken).
/// Weights are updated again after the last round.
///
/// Real time: allocates in the constructor only. An update costs the learner's update and O(m²) for
/// m centres and terms. Memory: bytes().
class Committee final : public OnlineRegressor {
 public:
  /// Composition of a committee.
  struct Plan {
    bool alone = false;    ///< the learner without the other members
    std::size_t line = 0;  ///< number of physics terms of `line`: the first terms of a sample
  };

  /// A sample consists of `inputs` scaled inputs and `terms` scaled physics terms. `settings` are
  /// the learner's. Throws InputError on settings that do not validate.
  Committee(std::size_t inputs, std::size_t terms, const OnlineSvrSettings& settings,
            const Plan& plan);

  /// Sets the budget of every further update (AdaptiveSvr::limit). Relearning has the budget's
  /// steps once more, one step per sample; the new sample is always learned.
  void limit(const Budget& budget) {
    learner_.limit(budget);
    budget_ = budget;
  }

  Decision update(std::span<const double> z, double y, double t) override;
  void alert(double since_s, bool another) override { learner_.alert(since_s, another); }
  double predict(std::span<const double> z) const override;
  Status status() const override { return learner_.status(); }
  std::vector<MemberShare> members() const override;

  /// predict(), equal to rounding, and its gradient by z and φ. Requirements of
  /// mixed_value_with_gradient().
  double with_gradient(std::span<const double> z, std::span<double> gradient) const;

  /// Copies of the models in service. Allocates.
  FunctionMix function_mix() const;

  /// Updates such copies. Cost O(n inputs). Allocates nothing.
  void refresh(FunctionMix& copies) const;

  /// The weight of a physics term, as FunctionMix::term_weight().
  double term_weight(std::size_t k) const;
  /// The standard error of this weight in units of the standardised target per scaled term; NaN
  /// without the member `memory`.
  double term_error(std::size_t k) const;

  /// Moves to another scale, as AdaptiveSvr::rescale(). When the learner has switched, linear
  /// members take the scale over and forget nothing. Kernels have other places in another scale:
  /// `precise` and `memory` relearn the learner's buffer. An earlier relearning under way comes
  /// first, a slice per call.
  RescaleStatus rescale(const SampleMap& map);

  /// The vehicle enters a range where errors are not known yet: large errors are no outliers.
  void forget_usual_errors();

  /// Resumes learning from a function mix: the learner with the support vectors, at the time `t`
  /// [s], the other members with the values at these places, with the mix's weights and limits. A
  /// mix of a lone learner gives the learner, from whose buffer the other members learn. Requires a
  /// committee without samples, and functions of as many inputs and terms. Allocates.
  void resume_from(const FunctionMix& said, const PastModel::Completion& complete, double t);

  /// Begins with weights of the terms known beforehand; the last number is of the bias. `line`
  /// takes these as a prior, and a larger share until errors are known; terms have no range.
  /// Requires a committee without samples. Allocates.
  void expect(std::span<const double> weights);

  /// Follows a change of the vehicle by a known step of the terms' weights; the last number is of
  /// the bias. All members but `mean` take the step; those with terms know the vehicle less well
  /// from a new change on (`news`, as AdaptiveSvr::shift()). Allocates nothing.
  void shift(std::span<const double> step, const Decision& news);

  const AdaptiveSvr& learner() const { return learner_; }
  AdaptiveSvr& learner() { return learner_; }  ///< To add past models.

  /// For tests and for reading along.
  friend LearnerState state_of(const Committee& committee);

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Memory in bytes, known before construction. Requires settings that validate.
  static std::size_t bytes(std::size_t inputs, std::size_t terms, const OnlineSvrSettings& settings,
                           const Plan& plan);

 private:
  static constexpr std::size_t kMembers = 6;
  using WeightedFunctions = std::array<WeightedFunction, kMembers>;

  /// The members beside the learner.
  struct Fits {
    Fits(std::size_t inputs, std::size_t terms, std::size_t line_terms,
         const OnlineSvrSettings& learner);

    /// In the order of the shares.
    std::array<SparseRegression*, kMembers - 1> all() {
      return {&precise, &memory, &physics, &line, &mean};
    }
    std::array<const SparseRegression*, kMembers - 1> all() const {
      return {&precise, &memory, &physics, &line, &mean};
    }

    static constexpr std::size_t kWithKernels = 2;  ///< the first two

    SparseRegression precise;
    SparseRegression memory;
    SparseRegression physics;
    SparseRegression line;
    SparseRegression mean;
  };

  bool alone() const { return !fits_; }
  Limits limits() const;
  void see(std::span<const double> z, double y);
  const SvrFunction& function(std::size_t member) const;
  std::span<const WeightedFunction> weighted_functions(WeightedFunctions& room) const;
  double short_range_part(std::span<const double> z) const;
  void score(std::span<const double> z, double y);
  void learn_in(std::span<SparseRegression* const> fits, std::span<const double> z, double y,
                bool successive);
  void freeze_copies();
  void reset();
  void reset_for_new_vehicle();
  void relearn_buffer(int rounds);
  double take_from_buffer(std::size_t i);
  void relearn_slice();
  void rescale_fits(const SampleMap& map);
  SampleStore places_of(const SvrFunction& function, const PastModel::Completion& complete);

  AdaptiveSvr learner_;
  std::optional<Fits> fits_;                ///< empty: the learner is alone
  std::vector<SvrFunction> frozen_copies_;  ///< every member's model at the start of the block
  MemberShares shares_;
  SeenRange seen_;              ///< targets
  SeenTermRanges seen_terms_;   ///< empty: alone, or known beforehand
  Relearning to_learn_;         ///< the buffer's samples that the fits have still to relearn
  bool kernels_only_ = false;   ///< these fits are `precise` and `memory`
  std::vector<double> sample_;  ///< scratch
  Budget budget_;               ///< of every update
};

}  // namespace kelpie
