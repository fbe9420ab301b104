// SPDX-License-Identifier: Apache-2.0
#include "posterior/mixture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "core/vector.hpp"
#include "kelpie/svr/online_svr.hpp"
#include "learner/sample_map.hpp"
#include "learner/tuning.hpp"
#include "posterior/tuning.hpp"

namespace kelpie {
namespace {

constexpr std::array<std::string_view, 4> kMembersOfMixture{"posterior", "terms", "svr", "mean"};

FunctionMix members_of(const SvrFunction& posterior, const SvrFunction& paper) {
  const MixedKernel& kernel = posterior.kernel();
  const SvrFunction none(MixedKernel(kernel.local().gamma(), {}, kernel.inputs(), kernel.terms()),
                         0);
  FunctionMix mix;
  for (const SvrFunction* const function : {&posterior, &none, &paper, &none}) {
    mix.members.push_back({std::string(kMembersOfMixture[mix.members.size()]), 0.0, *function});
  }
  return mix;
}

}  // namespace

Mixture::Mixture(const SvrFunction& posterior, const OnlineSvrSettings& settings)
    : paper_(posterior.kernel().inputs(), posterior.kernel().terms(), settings),
      mix_(members_of(posterior, paper_.learner().model())),
      shares_(kPosterior.first_shares),
      seen_(kOnline.range.margin),
      seen_terms_(posterior.kernel().terms()) {
  mix_.limits.caution = kOnline.shares.caution;
  for (const FunctionMix::Member& member : mix_.members) {
    frozen_.push_back(member.function);
  }
  limit();
  serve();
}

std::vector<MemberShare> Mixture::members() const {
  std::vector<MemberShare> list;
  for (const FunctionMix::Member& member : mix_.members) {
    list.push_back({member.name, member.share});
  }
  return list;
}

void Mixture::update(std::span<const double> z, double y, double t) {
  see(z, y);
  paper_.update(z, y, t);
  serve();
  if (shares_.block_ended()) {
    freeze();
  }
}

void Mixture::score(std::span<const double> z, double y, std::size_t block) {
  const auto [low, high, caution] = mix_.limits;
  const ScaledSample moved = within_ranges(mix_.term_ranges, z);
  std::array<double, kMembers> errors{};
  for (std::size_t k = 0; k < kMembers; ++k) {
    errors.at(k) = std::abs(y - std::clamp(frozen_[k](as_span(moved)), low, high));
  }
  if (!paper_.ready()) {
    errors[kOfPaper] = errors[kOfPosterior];
  }
  shares_.score(errors, block);
}

void Mixture::see(std::span<const double> z, double y) {
  seen_.add(y);
  seen_terms_.add(z);
  limit();
}

void Mixture::limit() {
  mix_.term_ranges = seen_terms_.ranges();
  const auto [low, high] = seen_.range();
  mix_.limits.low = std::min(low, certain_.low);
  mix_.limits.high = std::max(high, certain_.high);
}

void Mixture::serve() {
  for (std::size_t k = 0; k < kMembers; ++k) {
    mix_.members[k].share = shares_.shares()[k];
  }
  if (paper_.ready()) {
    mix_.members[kOfPaper].function.assign(paper_.learner().model());
  } else {
    mix_.members[kOfPosterior].share += mix_.members[kOfPaper].share;
    mix_.members[kOfPaper].share = 0.0;
  }
}

void Mixture::freeze() {
  for (std::size_t k = 0; k < kMembers; ++k) {
    frozen_[k].assign(mix_.members[k].function);
  }
}

void Mixture::assign_posterior(const SampleStore& centres, std::span<const double> beta,
                               std::span<const double> weights, const ValueRange& certain) {
  mix_.members[kOfPosterior].function.assign(centres, beta, weights.first(weights.size() - 1),
                                             weights.back());
  certain_ = certain;
  limit();
}

// Weights of all terms, or of none.
void Mixture::assign_linear(Place member, std::span<const double> weights) {
  SvrFunction& function = mix_.members[member].function;
  std::array<double, kMostTerms + 1> room{};
  const std::span<double> all = std::span(room).first(function.term_weights().size() + 1);
  std::ranges::copy(weights.first(weights.size() - 1), all.begin());
  all.back() = weights.back();
  function.clear();
  function.add(all);
}

void Mixture::move(const SampleMap& map) {
  std::array<double, kMostInputs + kMostTerms> room{};
  const MixedKernel& kernel = mix_.members[kOfPosterior].function.kernel();
  const std::span<double> factors = std::span(room).first(kernel.dimension());
  const LinearPart target = linear_part(map, factors);
  seen_.rescale(target.gain, target.offset);
  seen_terms_.rescale(factors.last(kernel.terms()));
  limit();
  move_paper(map);
  serve();
}

void Mixture::move_paper(const SampleMap& map) {
  paper_.move(map);
  mix_.members[kOfPaper].function.clear();
}

void Mixture::tell_anew(std::span<const double> step) {
  const std::size_t inputs = mix_.members[kOfPosterior].function.kernel().inputs();
  move_paper([&](std::span<double> sample, double& y) {
    y += dot(step.first(step.size() - 1), sample.subspan(inputs)) + step.back();
  });
  shares_.start_block();
  serve();
}

void Mixture::clear() {
  paper_.clear();
  for (FunctionMix::Member& member : mix_.members) {
    member.function.clear();
  }
  begin_shares();
  seen_.clear();
  seen_terms_ = SeenTermRanges(mix_.members[kOfPosterior].function.kernel().terms());
  certain_ = {0.0, 0.0};
  limit();
  serve();
}

void Mixture::expect_vehicle() {
  mix_.nominal.assign(mix_.members[kOfPosterior].function.kernel().terms(), 0.0);
  begin_shares();
  serve();
}

void Mixture::begin_shares() {
  shares_ = MemberShares(mix_.nominal.empty() ? kPosterior.first_shares
                                              : kPosterior.first_shares_of_known);
}

void Mixture::assign_nominal(std::span<const double> weights) {
  std::ranges::copy(weights, mix_.nominal.begin());
}

void Mixture::visit(Archive& archive) {
  archive.part("svr", paper_);
  archive.part("shares", shares_);
  archive.part("targets", seen_);
  archive.part("terms", seen_terms_);
  for (std::size_t k = 0; k < kMembers; ++k) {
    archive.part("frozen", frozen_[k]);
  }
  if (archive.loading()) {
    limit();
    serve();
  }
}

std::size_t Mixture::bytes(std::size_t inputs, std::size_t terms, std::size_t centres,
                           const OnlineSvrSettings& settings) {
  const std::size_t linear = SvrFunction::bytes(inputs, terms, 0);
  return PaperMember::bytes(inputs, terms, settings) + SeenTermRanges::bytes(terms) +
         (terms + 1) * sizeof(double) +
         2 * (SvrFunction::bytes(inputs, terms, centres) + 2 * linear +
              SvrFunction::bytes(inputs, terms, settings.places()) +
              kMembers * sizeof(FunctionMix::Member));
}

}  // namespace kelpie
