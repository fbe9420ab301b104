// SPDX-License-Identifier: Apache-2.0
#include "learner/committee.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "core/eigen.hpp"
#include "learner/learner_state.hpp"
#include "learner/sample_map.hpp"
#include "learner/tuning.hpp"

namespace kelpie {
namespace {

constexpr std::array<std::string_view, 6> kNames{"learner", "precise", "memory",
                                                 "physics", "line",    "mean"};

constexpr std::size_t kLine = 4;

// Samples of many inputs lie farther apart.
double input_width(std::size_t inputs) {
  return std::sqrt(kOnline.members.gamma_inputs / static_cast<double>(inputs));
}

SparseRegressionSettings precise_settings(std::size_t inputs, std::size_t terms,
                                          const OnlineSvrSettings& learner) {
  return {.terms = terms,
          .most_centres =
              std::min(kOnline.members.precise_centres, static_cast<std::size_t>(learner.buffer)),
          .gamma = kOnline.members.precise_gamma * input_width(inputs),
          .new_place = kOnline.members.precise_new_place,
          .ridge = kOnline.members.precise_ridge,
          .term_prior = kOnline.members.precise_term_prior};
}

SparseRegressionSettings memory_settings(std::size_t inputs, std::size_t terms,
                                         const OnlineSvrSettings& learner) {
  return {.terms = terms,
          .most_centres = std::min(kOnline.members.memory_centres,
                                   static_cast<std::size_t>(learner.buffer) / 2),
          .gamma = kOnline.members.memory_gamma * input_width(inputs)};
}

SparseRegressionSettings physics_settings(std::size_t terms) {
  return {.terms = terms, .term_prior = kOnline.members.physics_term_prior};
}

SparseRegressionSettings line_settings(std::size_t terms) {
  return {.terms = terms, .prior_by_noise = true};
}

std::vector<double> first_shares(bool alone) {
  const std::span<const double> relative(kOnline.members.first_shares);
  std::vector<double> shares(relative.begin(), alone ? relative.begin() + 1 : relative.end());
  as_vector(shares) /= as_vector(shares).sum();
  return shares;
}

const FunctionMix::Member* find_member(const FunctionMix& mix, std::string_view name) {
  const auto found = std::ranges::find(mix.members, name, &FunctionMix::Member::name);
  return found == mix.members.end() ? nullptr : &*found;
}

// A mix of an earlier version has no `physics`.
bool is_of_committee(const FunctionMix& mix) {
  return std::ranges::all_of(kNames, [&](std::string_view name) {
    return name == "physics" || find_member(mix, name) != nullptr;
  });
}

// In place of a lacking `physics`, half of `memory`.
WeightedFunction in_mix(const FunctionMix& mix, std::string_view name) {
  const bool lacking = find_member(mix, "physics") == nullptr;
  const bool halved = lacking && (name == "physics" || name == "memory");
  const FunctionMix::Member& found = *find_member(mix, halved ? "memory" : name);
  return {.share = halved ? 0.5 * found.share : found.share, .function = &found.function};
}

}  // namespace

Committee::Fits::Fits(std::size_t inputs, std::size_t terms, std::size_t line_terms,
                      const OnlineSvrSettings& learner)
    : precise(inputs, terms, precise_settings(inputs, terms, learner)),
      memory(inputs, terms, memory_settings(inputs, terms, learner)),
      physics(inputs, terms, physics_settings(terms)),
      line(inputs, terms, line_settings(line_terms)),
      mean(inputs, terms, {}) {}

Committee::Committee(std::size_t inputs, std::size_t terms, const OnlineSvrSettings& settings,
                     const Plan& plan)
    : learner_(inputs, settings, terms),
      shares_(first_shares(plan.alone)),
      seen_(kOnline.range.margin),
      to_learn_(plan.alone ? 0 : settings.places()),
      sample_(inputs + terms) {
  if (!plan.alone) {
    seen_terms_ = SeenTermRanges(terms);
    fits_.emplace(inputs, terms, plan.line, settings);
    for (std::size_t k = 0; k < kMembers; ++k) {
      frozen_copies_.push_back(function(k));
    }
  }
}

std::size_t Committee::bytes(std::size_t inputs, std::size_t terms,
                             const OnlineSvrSettings& settings, const Plan& plan) {
  std::size_t sum = sizeof(Committee) + AdaptiveSvr::bytes(inputs, settings, terms) +
                    (inputs + terms) * sizeof(double);
  if (!plan.alone) {
    const std::size_t places = settings.places();
    sum += SeenTermRanges::bytes(terms) + places * sizeof(std::uint64_t) + sizeof(SvrFunction) +
           SvrFunction::bytes(inputs, terms, places);
    for (const SparseRegressionSettings& fit :
         {precise_settings(inputs, terms, settings), memory_settings(inputs, terms, settings),
          physics_settings(terms), line_settings(plan.line), SparseRegressionSettings{}}) {
      sum += SparseRegression::bytes(inputs, terms, fit) + sizeof(SvrFunction) +
             SvrFunction::bytes(inputs, terms, fit.most_centres);
    }
  }
  return sum;
}

Decision Committee::update(std::span<const double> z, double y, double t) {
  if (alone()) {
    return learner_.update(z, y, t);
  }
  const double said = predict(z);
  Decision decision = learner_.update(z, y, t, std::abs(y - (said - short_range_part(z))));
  decision.prediction.value = said;
  if (decision.verdict == Verdict::invalid) {
    return decision;
  }
  if (decision.had_model) {
    shares_.calibrate(said, fits_->mean.model()(z), y);
  }
  if (decision.changed || decision.withdrawn) {
    if (decision.changed && decision.recalled == 0) {
      reset_for_new_vehicle();
    } else {
      reset();
    }
    relearn_buffer(kOnline.members.rounds);
  } else {
    if (to_learn_.done()) {
      score(z, y);
    }
    see(z, y);
    learn_in(fits_->all(), z, y, true);
    relearn_slice();
  }
  if (shares_.block_ended()) {
    freeze_copies();
  }
  return decision;
}

void Committee::see(std::span<const double> z, double y) {
  seen_.add(y);
  seen_terms_.add(z);
}

// By what every member said before it had learned the block that the sample is of.
void Committee::score(std::span<const double> z, double y) {
  const auto [low, high] = seen_.range();
  const ScaledSample moved = within_ranges(seen_terms_.ranges(), z);
  std::array<double, kMembers> errors{};
  for (std::size_t k = 0; k < kMembers; ++k) {
    errors[k] = std::abs(y - std::clamp(frozen_copies_[k](as_span(moved)), low, high));
  }
  shares_.score(errors);
}

void Committee::learn_in(std::span<SparseRegression* const> fits, std::span<const double> z,
                         double y, bool successive) {
  for (SparseRegression* const fit : fits) {
    budget_.charge(fit->work());
    fit->learn(z, y, successive);
  }
}

void Committee::freeze_copies() {
  for (std::size_t k = 0; k < kMembers; ++k) {
    frozen_copies_[k] = function(k);
  }
}

void Committee::reset() {
  std::ranges::for_each(fits_->all(), &SparseRegression::clear);
}

void Committee::reset_for_new_vehicle() {
  const auto all = fits_->all();
  fits_->precise.weaken();
  std::ranges::for_each(std::span(all).subspan(1), &SparseRegression::clear);
}

void Committee::relearn_buffer(int rounds) {
  seen_.clear();
  seen_terms_.clear();
  const SampleCollector& buffer = learner_.champion().buffer();
  for (std::size_t i = 0; i < buffer.size(); ++i) {
    const double y = take_from_buffer(i);
    see(sample_, y);
  }
  to_learn_.begin(buffer, rounds);
  kernels_only_ = false;
  relearn_slice();
}

// Copies a sample of the learner's buffer to sample_; the target, with the change since.
double Committee::take_from_buffer(std::size_t i) {
  const SampleCollector& buffer = learner_.champion().buffer();
  buffer.samples().get(i, sample_);
  return buffer.problem().targets()[i] + learner_.change()(sample_);
}

void Committee::relearn_slice() {
  const SampleCollector& buffer = learner_.champion().buffer();
  const bool relearning = !to_learn_.done();
  const auto all = fits_->all();
  const std::span<SparseRegression* const> fits(all.data(),
                                                kernels_only_ ? Fits::kWithKernels : all.size());
  Budget part = budget_.split_half();
  for (std::size_t k = 0; k < kOnline.members.slice && !to_learn_.round_done() && part.spend();
       ++k) {
    if (const std::optional<std::size_t> i = to_learn_.next(buffer)) {
      const double y = take_from_buffer(*i);
      learn_in(fits, sample_, y, false);
    }
  }
  std::ranges::for_each(all, &SparseRegression::publish);
  if (relearning && to_learn_.done()) {
    shares_.halve_evidence();
    freeze_copies();
  } else if (relearning && to_learn_.round_done()) {
    std::ranges::for_each(fits, &SparseRegression::start_over);
    to_learn_.next_round(buffer);
  }
}

void Committee::resume_from(const FunctionMix& said, const PastModel::Completion& complete,
                            double t) {
  const auto support = [&](std::size_t member, const OnlineSvr& like) {
    PastModel past(like.buffer().kernel(), like.settings().places());
    past.keep(said.members[member].function, like.settings(), complete);
    return past;
  };
  learner_.resume_from(support(0, learner_.champion()), t);
  if (alone()) {
    return;
  }
  if (!is_of_committee(said)) {
    reset();
    relearn_buffer(1);
    while (!to_learn_.done()) {
      relearn_slice();
    }
    return;
  }
  std::array<double, kMembers> shares{in_mix(said, kNames[0]).share};
  for (std::size_t k = 1; k < kMembers; ++k) {
    const auto [share, function] = in_mix(said, kNames[k]);
    fits_->all()[k - 1]->imitate(*function, places_of(*function, complete));
    shares[k] = share;
  }
  shares_.resume_from(shares);
  seen_.resume_from({said.limits.low, said.limits.high});
  seen_terms_.resume_from(said.term_ranges);
  freeze_copies();
}

// The centres of a function, then the learner's samples.
SampleStore Committee::places_of(const SvrFunction& function,
                                 const PastModel::Completion& complete) {
  const SampleStore& centres = function.support_vectors();
  const SampleStore& samples = learner_.champion().buffer().samples();
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
  WeightedFunctions room;
  return alone() || !learner_.champion().ready()
             ? learner_.predict(z)
             : mixed_value(weighted_functions(room), limits(), seen_terms_.ranges(), z);
}

// What the learner's fine part adds to the weighted mean.
double Committee::short_range_part(std::span<const double> z) const {
  const auto bounded = [seen = seen_.range()](double said) {
    return std::clamp(said, seen.low, seen.high);
  };
  const ScaledSample moved = within_ranges(seen_terms_.ranges(), z);
  const std::span<const double> limited = as_span(moved);
  const SvrFunction& model = learner_.model();
  return learner_.champion().ready()
             ? shares_.shares()[0] *
                   (bounded(model(limited)) - bounded(model.without_short_range(limited)))
             : 0.0;
}

double Committee::with_gradient(std::span<const double> z, std::span<double> gradient) const {
  WeightedFunctions room;
  return mixed_value_with_gradient(weighted_functions(room), limits(), seen_terms_.ranges(), z,
                                   gradient);
}

std::vector<MemberShare> Committee::members() const {
  std::vector<MemberShare> list;
  for (std::size_t k = 0; !alone() && k < kMembers; ++k) {
    list.push_back({std::string(kNames[k]), shares_.shares()[k]});
  }
  return list;
}

void Committee::refresh(FunctionMix& copies) const {
  copies.limits = limits();
  copies.term_ranges = seen_terms_.ranges();
  for (std::size_t k = 0; k < copies.members.size(); ++k) {
    copies.members[k].share = shares_.shares()[k];
    copies.members[k].function.assign(function(k));
  }
}

FunctionMix Committee::function_mix() const {
  FunctionMix copies{.members = {}, .limits = limits(), .term_ranges = seen_terms_.ranges()};
  for (std::size_t k = 0; k < shares_.shares().size(); ++k) {
    copies.members.push_back({std::string(kNames[k]), shares_.shares()[k], function(k)});
  }
  return copies;
}

double Committee::term_weight(std::size_t k) const {
  WeightedFunctions room;
  double sum = 0.0;
  for (const WeightedFunction& weighted : weighted_functions(room)) {
    sum += weighted.share * weighted.function->term_weights()[k];
  }
  return sum;
}

double Committee::term_error(std::size_t k) const {
  return alone() ? std::numeric_limits<double>::quiet_NaN() : fits_->memory.term_error(k);
}

void Committee::forget_usual_errors() {
  if (!alone()) {
    std::ranges::for_each(fits_->all(), &SparseRegression::forget_usual_error);
  }
}

RescaleStatus Committee::rescale(const SampleMap& map) {
  if (!to_learn_.done()) {  // one long job at a time
    relearn_slice();
    return RescaleStatus::under_way;
  }
  const RescaleStatus step = learner_.rescale(map);
  if (step == RescaleStatus::switched && !alone()) {
    rescale_fits(map);
  }
  return step;
}

void Committee::rescale_fits(const SampleMap& map) {
  const auto [gain, offset] = linear_part(map, sample_);
  const SampleCollector& buffer = learner_.champion().buffer();
  const auto factors = std::span<const double>(sample_).subspan(buffer.kernel().inputs());
  seen_.rescale(gain, offset);
  seen_terms_.rescale(factors);
  for (SparseRegression* const fit : fits_->all()) {
    fit->rescale(factors, gain, offset);
  }
  to_learn_.begin(buffer, 1);
  kernels_only_ = true;
  relearn_slice();
}

void Committee::expect(std::span<const double> weights) {
  if (alone()) {
    return;
  }
  fits_->line.expect(weights, kOnline.members.nominal_known);
  seen_terms_ = SeenTermRanges();
  std::vector<double> shares = first_shares(false);
  as_vector(shares) *= 1.0 - kOnline.members.nominal_share;
  shares[kLine] += kOnline.members.nominal_share;
  shares_.resume_from(shares);
  freeze_copies();
}

void Committee::shift(std::span<const double> step, const Decision& news) {
  if (alone()) {
    return;
  }
  for (SparseRegression* const fit :
       {&fits_->precise, &fits_->memory, &fits_->physics, &fits_->line}) {
    if (!step.empty()) {
      fit->shift(step);
    }
    if (news.changed) {
      fit->doubt_terms(kOnline.members.kept);
    }
  }
  learner_.shift(step, news);
  if (news.changed || news.withdrawn) {
    shares_.halve_evidence();
  }
  freeze_copies();
}

// Members that know nothing yet, or whose scale is too small, disagree for another reason than the
// place.
Limits Committee::limits() const {
  using Task = AdaptiveSvr::SliceTask;
  const bool relearning = !to_learn_.done();
  const bool outgrown = learner_.task() == Task::rescale || learner_.task() == Task::catch_up;
  const auto [low, high] = seen_.range();
  return {.low = low,
          .high = high,
          .caution = alone() || relearning || outgrown ? 0.0 : kOnline.members.caution};
}

const SvrFunction& Committee::function(std::size_t member) const {
  return member == 0 ? learner_.model() : fits_->all()[member - 1]->model();
}

std::span<const WeightedFunction> Committee::weighted_functions(WeightedFunctions& room) const {
  const std::size_t members = shares_.shares().size();
  for (std::size_t k = 0; k < members; ++k) {
    room[k] = {.share = shares_.shares()[k], .function = &function(k)};
  }
  return {room.data(), members};
}

void Committee::visit(Archive& archive) {
  archive.part("learner", learner_);
  for (std::size_t k = 1; !alone() && k < kMembers; ++k) {
    archive.part(kNames[k], *fits_->all()[k - 1]);
  }
  std::ranges::for_each(frozen_copies_, [&](SvrFunction& one) { archive.part("looked", one); });
  archive.part("to learn", to_learn_);
  archive.flag(kernels_only_);
  archive.part("shares", shares_);
  archive.part("seen", seen_);
  archive.part("seen terms", seen_terms_);
}

LearnerState state_of(const Committee& committee) {
  const AdaptiveSvr& learner = committee.learner_;
  using Comparison = LearnerState::Comparison;
  const ChangeDetector& detector = learner.detector();
  return {.comparison = detector.on_probation() ? Comparison::probation
                        : detector.trying()     ? Comparison::challenger
                                                : Comparison::none,
          .task = learner.task(),
          .past_models = learner.past_models().state(),
          .relearning = !committee.to_learn_.done()};
}

}  // namespace kelpie
