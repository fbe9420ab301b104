// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/core/archive.hpp"
#include "kelpie/svr/regressor.hpp"
#include "kelpie/svr/resources.hpp"
#include "kelpie/svr/settings.hpp"
#include "learner/member_shares.hpp"
#include "learner/seen_range.hpp"
#include "posterior/paper_member.hpp"
#include "posterior/posterior.hpp"
#include "svr/function_mix.hpp"

namespace kelpie {

/// The function in service of an axis, on scaled samples: the mean of four members, weighted by
/// losses on samples that the members have not learned yet (MemberShares):
///
///     posterior  the posterior's mean
///     terms      the posterior of the terms of the equation of motion alone, without kernel
///     svr        the paper's learner
///     mean       the mean of the targets, for axes without predictable structure
///
/// Limits: terms stay within twice their ranges, disagreement of the members
/// shrinks the value towards the mean, and each member stays within the targets seen (SeenRange).
/// The targets' range is widened to what the terms are certain of, so that effects may meet which
/// never met before. Beside a vehicle known beforehand, the members say what that vehicle leaves.
///
/// Allocates in the constructor, and in move().
class Mixture {
 public:
  /// `posterior`: an empty function of the posterior's kernel, with room for its centres.
  Mixture(const SvrFunction& posterior, const OnlineSvrSettings& settings);

  const FunctionMix& function() const { return mix_; }  ///< In service.
  std::vector<MemberShare> members() const;
  bool unfinished() const { return paper_.unfinished(); }

  void limit(const Budget& budget) { paper_.limit(budget); }

  /// Scores what the members said `block` samples before, or fewer, by a sample that no member has
  /// learned yet. Requires trusted inputs.
  void score(std::span<const double> z, double y, std::size_t block);
  /// Lets the paper's learner learn a sample, and widens the limits.
  void update(std::span<const double> z, double y, double t);

  /// Functions of a solve. `weights`: of the terms, the last number the bias; `certain`: the range
  /// of values that the terms are certain of.
  void assign_posterior(const SampleStore& centres, std::span<const double> beta,
                        std::span<const double> weights, const ValueRange& certain);
  void assign_terms(std::span<const double> weights) { assign_linear(kOfTerms, weights); }
  void assign_mean(std::span<const double> weights) { assign_linear(kOfMean, weights); }
  /// Weights of the terms of the vehicle known beforehand. Requires expect_vehicle() before.
  void assign_nominal(std::span<const double> weights);

  /// Samples are in another scale from now on, `map` of the scale so far. Functions of a solve
  /// have to be assigned next, and then freeze() called.
  void move(const SampleMap& map);
  void freeze();

  /// The samples are those of a vehicle with other weights of the terms: each target grows by the
  /// step, the last number of which is the bias. Functions of a solve have to be assigned next, and
  /// then freeze() called.
  void tell_anew(std::span<const double> step);

  /// Forgets all samples. Functions of a solve have to be assigned next, and then freeze() called.
  void clear();

  /// Targets are what a vehicle known beforehand leaves: their mean has the largest share until
  /// errors are known. Requires that nothing has been learned yet.
  void expect_vehicle();

  void visit(Archive& archive);  ///< core/archive.hpp; without functions of a solve

  /// Memory in bytes, beside the object itself. Requires settings that validate.
  static std::size_t bytes(std::size_t inputs, std::size_t terms, std::size_t centres,
                           const OnlineSvrSettings& settings);

 private:
  enum Place : std::size_t { kOfPosterior, kOfTerms, kOfPaper, kOfMean, kMembers };

  void assign_linear(Place member, std::span<const double> weights);
  void begin_shares();
  void see(std::span<const double> z, double y);
  void move_paper(const SampleMap& map);
  void limit();
  void serve();

  PaperMember paper_;
  FunctionMix mix_;
  MemberShares shares_;
  SeenRange seen_;  ///< targets
  SeenTermRanges seen_terms_;
  ValueRange certain_{0.0, 0.0};     ///< of values of terms
  std::vector<SvrFunction> frozen_;  ///< the members at the begin of a block of losses
};

}  // namespace kelpie
