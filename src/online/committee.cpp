// SPDX-License-Identifier: Apache-2.0
#include "kelpie/online/committee.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

namespace kelpie {
namespace {

constexpr std::array<std::string_view, 5> kNames{"learner", "precise", "memory", "line", "mean"};
constexpr std::size_t kMemory = 2;  // the first of the fits

constexpr std::size_t kMostCentres = 150;
constexpr int kPreciseBuffer = 450;

// What suits logs without noise: chosen by the streams of docs/alternatives.md.
OnlineSvrSettings precise_settings(const OnlineSvrSettings& settings) {
  OnlineSvrSettings precise = settings;
  precise.c = 20.0;
  precise.epsilon = 0.055;
  precise.fine = 0.0;
  precise.buffer = std::min(settings.buffer, kPreciseBuffer);
  precise.adapt = AdaptRule::none;
  return precise;
}

std::array<LongMemorySettings, 3> fit_settings(std::size_t terms, const Committee::Plan& plan) {
  return {{{.terms = terms, .most_centres = kMostCentres}, {.terms = plan.line}, {}}};
}

std::vector<LongMemory> make_fits(std::size_t inputs, std::size_t terms,
                                  const Committee::Plan& plan) {
  std::vector<LongMemory> fits;
  fits.reserve(3);
  if (!plan.alone) {
    for (const LongMemorySettings& settings : fit_settings(terms, plan)) {
      fits.emplace_back(inputs, terms, settings);
    }
  }
  return fits;
}

}  // namespace

Committee::Committee(std::size_t inputs, std::size_t terms, const OnlineSvrSettings& settings,
                     const Plan& plan)
    : learner_(inputs, settings, terms),
      fits_(make_fits(inputs, terms, plan)),
      shares_(plan.alone ? 1 : kMembers),
      order_(plan.alone ? 0 : settings.places()),
      sample_(inputs + terms) {
  if (!plan.alone) {
    precise_.reserve(1);
    precise_.emplace_back(inputs, precise_settings(settings), terms);
    looked_.reserve(kMembers);
    for (std::size_t k = 0; k < kMembers; ++k) {
      looked_.push_back(function(k));
    }
  }
}

std::size_t Committee::bytes(std::size_t inputs, std::size_t terms,
                             const OnlineSvrSettings& settings, const Plan& plan) {
  std::size_t sum = sizeof(Committee) + AdaptiveSvr::bytes(inputs, settings, terms) +
                    (inputs + terms) * sizeof(double);
  if (!plan.alone) {
    const OnlineSvrSettings precise = precise_settings(settings);
    sum += settings.places() * sizeof(std::size_t) + OnlineSvr::bytes(inputs, precise, terms);
    for (const OnlineSvrSettings& svr : {settings, precise}) {
      sum += sizeof(SvrFunction) + SvrFunction::bytes(inputs, terms, svr.places());
    }
    for (const LongMemorySettings& fit : fit_settings(terms, plan)) {
      sum += sizeof(LongMemory) + LongMemory::bytes(inputs, terms, fit) + sizeof(SvrFunction) +
             SvrFunction::bytes(inputs, terms, fit.most_centres);
    }
  }
  return sum;
}

void Committee::limit(const Budget& budget) {
  learner_.limit(budget);
  std::ranges::for_each(precise_, [&](OnlineSvr& precise) { precise.limit(budget); });
}

Decision Committee::update(std::span<const double> z, double y, double t) {
  if (alone()) {
    return learner_.update(z, y, t);
  }
  const double said = predict(z);
  Decision decision = learner_.update(z, y, t);
  decision.predicted = said;
  if (decision.verdict == Verdict::invalid) {
    return decision;
  }
  judge(z, y);
  if (decision.changed || decision.withdrawn) {
    begin_anew();
  } else {
    teach(z, y, t);
  }
  if (shares_.block_ended()) {
    look();
  }
  return decision;
}

void Committee::teach(std::span<const double> z, double y, double t) {
  precise_.front().update(z, y, t);
  for (LongMemory& fit : fits_) {
    fit.update(z, y);
  }
  seen_.add(y);
}

// By what every member said before it had learned the block that the sample is of.
void Committee::judge(std::span<const double> z, double y) {
  const Bounds bounds = seen_.bounds();
  std::array<double, kMembers> errors{};
  for (std::size_t k = 0; k < kMembers; ++k) {
    errors[k] = std::abs(y - std::clamp(looked_[k](z), bounds.low, bounds.high));
  }
  shares_.judge(errors);
}

void Committee::look() {
  for (std::size_t k = 0; k < kMembers; ++k) {
    looked_[k] = function(k);
  }
}

// All but the learner, with what it knows.
void Committee::begin_anew() {
  const SampleCollector& buffer = std::as_const(learner_).champion().buffer();
  precise_.front().clear();
  std::ranges::for_each(fits_, &LongMemory::clear);
  seen_.clear();
  const std::span<std::size_t> order = std::span(order_).first(buffer.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return buffer.arrival(i); });
  for (const std::size_t i : order) {
    buffer.samples().get(i, sample_);
    teach(sample_, buffer.problem().targets()[i], buffer.time(i));
  }
  shares_.restart_block();
  look();
}

void Committee::go_on_with(const Consensus& said, const PastModel::Completion& complete, double t) {
  const auto support = [&](std::size_t member, const OnlineSvr& like) {
    PastModel past(like.buffer().kernel(), like.settings().places());
    past.keep(said.members[member].function, like.settings(), complete);
    return past;
  };
  learner_.take_up(support(0, std::as_const(learner_).champion()), t);
  if (alone()) {
    return;
  }
  if (said.members.size() != kMembers) {
    begin_anew();
    return;
  }
  precise_.front().take_up(support(1, precise_.front()), t);
  for (std::size_t k = kMemory; k < kMembers; ++k) {
    const SvrFunction& function = said.members[k].function;
    fits_[k - kMemory].imitate(function, places_of(function, complete));
  }
  std::array<double, kMembers> shares{};
  std::ranges::transform(said.members, shares.begin(), &Consensus::Member::share);
  shares_.go_on_with(shares);
  seen_.go_on_with(said.bounds);
  look();
}

// The centres of a function, then the learner's samples.
SampleStore Committee::places_of(const SvrFunction& function,
                                 const PastModel::Completion& complete) {
  const SampleStore& centres = function.support_vectors();
  const SampleStore& samples = std::as_const(learner_).champion().buffer().samples();
  SampleStore places(samples.dimension(), centres.size() + samples.size());
  for (std::size_t i = 0; i < centres.size(); ++i) {
    centres.get(i, std::span(sample_).first(centres.dimension()));
    complete(sample_);
    places.push_back(sample_);
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples.get(i, sample_);
    places.push_back(sample_);
  }
  return places;
}

double Committee::predict(std::span<const double> z) const {
  Voices room;
  return alone() || !learner_.champion().ready()
             ? learner_.predict(z)
             : kelpie::consensus(voices(room), seen_.bounds(), z);
}

double Committee::with_gradient(std::span<const double> z, std::span<double> gradient) const {
  Voices room;
  return consensus_with_gradient(voices(room), seen_.bounds(), z, gradient);
}

std::vector<MemberShare> Committee::members() const {
  std::vector<MemberShare> list;
  for (std::size_t k = 0; !alone() && k < kMembers; ++k) {
    list.push_back({std::string(kNames[k]), shares_.shares()[k]});
  }
  return list;
}

void Committee::refresh(Consensus& copies) const {
  copies.bounds = seen_.bounds();
  for (std::size_t k = 0; k < copies.members.size(); ++k) {
    copies.members[k].share = shares_.shares()[k];
    copies.members[k].function.assign(function(k));
  }
}

Consensus Committee::consensus() const {
  Consensus copies{.members = {}, .bounds = seen_.bounds()};
  for (std::size_t k = 0; k < shares_.shares().size(); ++k) {
    copies.members.push_back({std::string(kNames[k]), shares_.shares()[k], function(k)});
  }
  return copies;
}

double Committee::term_weight(std::size_t k) const {
  Voices room;
  double sum = 0.0;
  for (const Voice& voice : voices(room)) {
    sum += voice.share * voice.function->term_weights()[k];
  }
  return sum;
}

double Committee::term_error(std::size_t k) const {
  return alone() ? std::numeric_limits<double>::quiet_NaN() : fits_.front().term_error(k);
}

void Committee::restate(const SampleMap& map) {
  learner_.restate(map);
  if (!alone()) {
    begin_anew();
  }
}

const SvrFunction& Committee::function(std::size_t member) const {
  switch (member) {
    case 0:
      return learner_.model();
    case 1:
      return precise_.front().model();
    default:
      return fits_[member - kMemory].model();
  }
}

std::span<const Voice> Committee::voices(Voices& room) const {
  const std::span<const double> shares = shares_.shares();
  for (std::size_t k = 0; k < shares.size(); ++k) {
    room[k] = {.share = shares[k], .function = &function(k)};
  }
  return {room.data(), shares.size()};
}

void Committee::visit(Archive& archive) {
  archive.part("learner", learner_);
  for (OnlineSvr& precise : precise_) {
    archive.part("precise", precise);
  }
  for (std::size_t k = 0; k < fits_.size(); ++k) {
    archive.part(kNames[kMemory + k], fits_[k]);
  }
  for (SvrFunction& function : looked_) {
    archive.part("looked", function);
  }
  archive.part("shares", shares_);
  archive.part("seen", seen_);
}

}  // namespace kelpie
