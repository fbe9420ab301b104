// SPDX-License-Identifier: Apache-2.0
#include "model/posterior_axis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "core/vector.hpp"
#include "kelpie/core/error.hpp"
#include "posterior/tuning.hpp"
#include "svr/valid_sample.hpp"

namespace kelpie {
namespace {

constexpr double kAll = std::numeric_limits<double>::infinity();  // samples

SvrFunction empty_function(const Features& features) {
  const KernelBasis& basis = features.basis();
  return {
      MixedKernel(basis.kernel().gamma(), {}, basis.centres().dimension(), features.terms().size()),
      basis.centres().capacity()};
}

// From the samples of one scale to the samples of another. Inputs without a unit stand at their
// mean.
SampleMap map_between(const AxisScaling& from, const AxisScaling& to) {
  return [from, to](std::span<double> sample, double& y) {
    const std::size_t inputs = from.input.dimension();
    const ScaledInput x = from.input.invert(sample.first(inputs));
    std::ranges::copy(to.input.apply(as_span(x)), sample.begin());
    for (std::size_t k = 0; k < to.term_scale.size(); ++k) {
      sample[inputs + k] *= from.term_scale[k] / to.term_scale[k];
    }
    y = to.target.apply(from.target.invert(y));
  };
}

}  // namespace

PosteriorAxis::PosteriorAxis(std::size_t inputs, const SharedSettings& shared,
                             const OnlineSvrSettings& settings, const TermSet& terms,
                             std::span<const std::size_t> states)
    : features_(inputs, terms, states, centres_of(settings)),
      posterior_(features_.capacity(), features_.terms_end()),
      screen_(inputs, features_.terms_end()),
      past_(features_.terms_end(), features_.capacity(), settings.past_models()),
      scaling_{.input = features_.units(),
               .target = {},
               .term_scale = std::vector<double>(terms.size(), 1.0)},
      mixture_(empty_function(features_), settings),
      known_{SampleStore(inputs, centres_of(settings)),
             KernelDensity(inputs, centres_of(settings),
                           KernelDensity::scott(inputs, centres_of(settings)))},
      uncertainty_(shared.coverage) {
  settings.validate();
  scratch_.reserve(features_.capacity());
}

std::size_t PosteriorAxis::centres_of(const OnlineSvrSettings& settings) {
  return static_cast<std::size_t>(settings.buffer) / kPosterior.buffer_per_centre + 1;
}

// The way of a sample.
Decision PosteriorAxis::update(std::span<const double> x, double y, double t) {
  trusted_last_ = false;
  if (!valid_sample(x, features_.units().dimension(), y, t)) {
    ++tally_.invalid;
    return {.verdict = Verdict::invalid,
            .prediction = {.value = std::numeric_limits<double>::quiet_NaN()},
            .had_model = posterior_.ready()};
  }
  Decision decision{.prediction = {.value = predict(x)}, .had_model = posterior_.ready()};
  uncertainty_.score(decision, y, t);
  trusted_last_ = features_.trust(x) == 1.0;
  const RecentRows::Row row{.x = x, .y = y, .left = y - expected(x), .t = t};
  const std::span<const double> phi = features_.evaluate(x);
  if (const PastVehicle* const back =
          past_.update(phi, row.left, t, features_.trust(x), posterior_)) {
    recall(*back, decision);
  }
  const bool was_on_probation = screen_.on_probation() != nullptr;
  screen_.add(row, features_, phi, posterior_);
  if (const std::optional<RowScreen::Won> won = screen_.won()) {
    won->is_change ? past_.leave(posterior_, won->since_s, features_.groups()) : past_.begin();
    begin_anew();
    decision.changed = won->is_change;
    decision.changed_since = won->since_s;
    tally_.changes += won->is_change ? 1 : 0;
  }
  for (int i = 0; i < kPosterior.rows_per_update; ++i) {
    if (const std::optional<RowScreen::Due> due = screen_.next()) {
      learn(*due);
    }
  }
  if (posterior_.wants_solve() && posterior_.solve(features_.groups(), budget_)) {
    take_over();
    decision.published = true;
  } else if (has_scale_ && (was_on_probation || screen_.on_probation() != nullptr)) {
    assign_members();
    decision.published = true;
  }
  decision.verdict = screen_.last_waits() ? Verdict::held_back : Verdict::accepted;
  tally_.implausible += screen_.dropped();
  return decision;
}

void PosteriorAxis::learn_held_back() {
  screen_.end_waiting(features_, posterior_);
  tally_.implausible += screen_.dropped();
  while (const std::optional<RowScreen::Due> due = screen_.next()) {
    learn(*due);
  }
  if (posterior_.ready()) {
    settle(posterior_, features_.groups());
    take_over();
  }
}

// The solution of the posterior goes into service.
void PosteriorAxis::take_over() {
  const bool fits =
      has_scale_ && posterior_.sums().targets().scale < kPosterior.outgrown * scaling_.target.scale;
  fits ? serve() : change_scale();
}

// Forgets what was learned; of the rows that are due, the first make a model at once.
void PosteriorAxis::begin_anew() {
  tally_.forgotten = tally_.accepted;
  posterior_.clear();
  features_.clear();
  past_.forget_kernel();
  known_.samples.clear();
  known_.density.clear();
  far_s_ = 0.0;
  mixture_.clear();
  has_scale_ = false;
  for (std::optional<RowScreen::Due> due; !has_scale_ && (due = screen_.next());) {
    learn(*due);
    if (posterior_.wants_solve()) {
      settle(posterior_, features_.groups());
      change_scale();
    }
  }
}

// The weights become those of the past vehicle. Where the past kernel is not known, what the kernel
// says beside the terms stays.
void PosteriorAxis::recall(const PastVehicle& back, Decision& decision) {
  TermWeights first(features_.terms_end());
  std::ranges::transform(back.posterior.weights(), posterior_.first_weights(), first.begin(),
                         std::minus<>{});
  first[0] += back.posterior.centre() - posterior_.centre();
  const std::span<const double> live = posterior_.weights();
  if (back.weights.empty()) {
    const SampleSums& sums = back.posterior.sums();
    tell_anew(as_span(first), first, kPosterior.kept);
    posterior_.add(sums, back.rows_per_sample * std::min(1.0, kPosterior.kept / sums.rows));
  } else {
    scratch_.assign(back.weights.begin(), back.weights.end());
    scratch_.resize(std::max(live.size(), scratch_.size()));
    std::ranges::transform(live, scratch_, scratch_.begin(),
                           [](double a, double b) { return b - a; });
    scratch_[0] -= posterior_.centre();
    tell_anew(scratch_, first, kAll);
  }
  screen_.believe_change(back.since_s);
  past_.recall(back);
  decision.changed = decision.returning = decision.published = true;
  decision.changed_since = back.since_s;
  decision.recalled = back.info.number;
  ++tally_.changes;
  ++tally_.recalls;
}

// What was learned becomes what would have been learned of the changed vehicle.
void PosteriorAxis::apply_change(std::span<const CommandGain> gains, std::span<const double> step,
                                 const Decision& news) {
  tally_.changes += news.changed ? 1 : 0;
  tally_.withdrawn += news.withdrawn ? 1 : 0;
  if (!has_scale_) {
    return;
  }
  TermWeights told(terms().size() + 1);
  std::ranges::fill(told, 0.0);
  if (gains.empty()) {
    std::ranges::copy(step.first(step.size() - 1), told.begin() + 1);
    told[0] = step.back();
  } else {
    for (std::size_t k = 1; k < told.size(); ++k) {
      const double weight = posterior_.weights()[k] + known(k);
      told[k] = (term_gain(terms(), k - 1, gains) - 1.0) * weight;
    }
  }
  double kept = kAll;
  if (news.changed) {
    kept = kPosterior.kept;
    past_.leave(posterior_, news.changed_since, features_.groups());
    screen_.believe_change(news.changed_since);
  } else if (news.withdrawn) {
    past_.come_back();
  }
  tell_anew(as_span(told), told, kept);
}

// `step`: of the weights; `first`: of the weights of the terms alone, which the targets of the
// paper's learner follow.
void PosteriorAxis::tell_anew(std::span<const double> step, const TermWeights& first, double kept) {
  posterior_.tell_anew(step, as_span(first), kept);
  mixture_.tell_anew(as_span(in_scale(first, first[0] / scaling_.target.scale)));
  serve();
  mixture_.freeze();
}

// Garbage ends; velocities that stay far away are those of a vehicle that has set off.
double PosteriorAxis::trust(std::span<const double> x, double t) {
  const double trust = features_.trust(x);
  const double step = std::clamp(t - last_s_, 0.0, kPosterior.longest_step_s);
  last_s_ = t;
  far_s_ = trust < 1.0 ? far_s_ + step : std::max(0.0, far_s_ - step);
  return far_s_ > kPosterior.garbage_s ? 1.0 : trust;
}

void PosteriorAxis::learn(const RowScreen::Due& due) {
  const auto& [x, y, left, t] = due.row;
  const double trust = this->trust(x, t);
  if (has_scale_) {
    const ScaledSample z = scale_sample(scaling_, terms(), x);
    if (trust == 1.0) {
      mixture_.score(as_span(z), in_scale(left), block_length());
    }
    mixture_.update(as_span(z), in_scale(left), t);
  }
  if (const std::optional<Matrix> map = features_.observe(x, trust)) {
    posterior_.change_features(features_.terms_end(), *map);
    past_.change_features(*map);
    known_.samples.clear();
    known_.density.clear();
    if (posterior_.ready()) {
      change_scale();
    }
  }
  posterior_.add(features_.learn(x), left, trust, due.likelihood);
  know_centres();
  ++tally_.accepted;
}

// What was known beforehand says of raw inputs.
double PosteriorAxis::expected(std::span<const double> x) const {
  if (prior_.empty()) {
    return 0.0;
  }
  std::array<double, kMostTerms> room{};
  const std::span<double> values = std::span(room).first(terms().size());
  terms().evaluate(x, values);
  return prior_.front() + dot(std::span(prior_).subspan(1), std::span<const double>(values));
}

// Inputs in the units of the kernel; terms and target by their sizes so far.
void PosteriorAxis::change_scale() {
  AxisScaling next{.input = features_.units(),
                   .target = posterior_.sums().targets(),
                   .term_scale = std::vector<double>(terms().size(), 1.0)};
  next.target.mean += known(0);
  for (std::size_t k = 0; k < terms().size(); ++k) {
    const double size = posterior_.sums().root_mean_square(k + 1);
    if (size > 0.0) {
      next.term_scale[k] = size;
    }
  }
  if (has_scale_) {
    mixture_.move(map_between(scaling_, next));
  }
  scaling_ = std::move(next);
  has_scale_ = true;
  serve();
  mixture_.freeze();
}

// Weights of the terms by scaled terms, the last number the bias.
PosteriorAxis::TermWeights PosteriorAxis::in_scale(TermWeights weights, double bias) const {
  for (std::size_t k = 1; k < weights.size(); ++k) {
    weights[k - 1] = weights[k] * scaling_.term_scale[k - 1] / scaling_.target.scale;
  }
  weights[weights.size() - 1] = bias;
  return weights;
}

void PosteriorAxis::serve() {
  certain_ = certain_range();
  assign_members();
}

// From the weights of the terms alone to those of rows on probation.
PosteriorAxis::TermWeights PosteriorAxis::step_on_probation() const {
  TermWeights step(features_.terms_end());
  std::ranges::fill(step, 0.0);
  if (const Posterior* const follower = screen_.on_probation()) {
    std::ranges::transform(follower->weights(), posterior_.first_weights(), step.begin(),
                           std::minus<>{});
    step[0] += follower->centre() - posterior_.centre();
  }
  return step;
}

// The posterior's mean as a function of scaled kernels and terms.
void PosteriorAxis::assign_members() {
  const std::span<const double> theta = posterior_.weights();
  const std::size_t first = features_.terms_end();
  scratch_.assign(features_.basis().size(), 0.0);  // centres that came since have no weight yet
  std::ranges::transform(theta.subspan(first), scratch_.begin(),
                         [&](double weight) { return weight / scaling_.target.scale; });
  features_.basis().to_kernel(scratch_);
  const double centre = posterior_.centre();
  const TermWeights step = step_on_probation();
  const auto scaled = [&](std::span<const double> weights) {
    TermWeights stepped(weights.size());
    std::ranges::transform(weights, step, stepped.begin(), std::plus<>{});
    return in_scale(stepped, in_scale(centre + stepped[0]));
  };
  const auto own = scaled(theta.first(first));
  mixture_.assign_posterior(features_.basis().centres(), scratch_, as_span(own),
                            {in_scale(certain_.low), in_scale(certain_.high)});
  mixture_.assign_terms(as_span(scaled(posterior_.first_weights())));
  const double mean = in_scale(centre);
  mixture_.assign_mean({&mean, 1});
  if (!prior_.empty()) {
    TermWeights nominal(first);
    std::ranges::copy(prior_, nominal.begin());
    mixture_.assign_nominal(as_span(in_scale(nominal, 0.0)).first(first - 1));
  }
}

// All that the inputs do, each alone beside the means of the others, at the ends of its range, as
// far as certain to three standard errors of the terms.
ValueRange PosteriorAxis::certain_range() {
  std::vector<double>& x = place_;
  x = features_.units().mean;
  std::array<double, kMostTerms + 1> room{}, moved{};
  const std::span<double> middle = std::span(room).first(features_.terms_end());
  const std::span<double> step = std::span(moved).first(middle.size());
  features_.first(x, middle);
  const double said = value(posterior_, features_.evaluate(x));
  const auto effect = [&](std::size_t input, double at) {
    const double mean = std::exchange(x[input], at);
    features_.first(x, step);
    std::ranges::transform(step, middle, step.begin(), std::minus<>{});
    const double sum = value(posterior_, features_.evaluate(x)) - said;
    x[input] = mean;
    const double unknown = kPosterior.certain * posterior_.look(step, 0.0).error;
    return std::copysign(std::max(0.0, std::abs(sum) - unknown), sum);
  };
  ValueRange range{said, said};
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto [low, high] = features_.ranges()[i];
    if (low <= high) {
      const auto [least, most] = std::minmax({0.0, effect(i, low), effect(i, high)});
      range.low += least;
      range.high += most;
    }
  }
  return range;
}

// Novelty compares places with all centres.
void PosteriorAxis::know_centres() {
  std::array<double, kMostInputs> z{};
  const std::span<double> centre = std::span(z).first(features_.units().dimension());
  while (known_.samples.size() < features_.basis().size()) {
    features_.basis().centres().get(known_.samples.size(), centre);
    known_.density.add(centre, known_.samples);
    known_.samples.push_back(centre);
  }
}

// A block of losses holds independent samples.
std::size_t PosteriorAxis::block_length() const {
  const double rows = kPosterior.block * posterior_.rows_per_sample();
  return std::clamp(static_cast<std::size_t>(rows), MemberShares::kBlock, MemberShares::kMostBlock);
}

double PosteriorAxis::predict(std::span<const double> x) const {
  return has_scale_ ? ServedAxis<FunctionMix>{scaling_, terms(), mixture_.function()}.predict(x)
                    : posterior_.centre() + expected(x);
}

Prediction PosteriorAxis::assess(std::span<const double> x, double ahead_s) const {
  if (!has_scale_) {
    return {.value = predict(x), .novelty = 1.0};
  }
  const auto novelty = [&](std::span<const double> z) { return known_.novelty(z); };
  return ServedAxis<FunctionMix>{scaling_, terms(), mixture_.function()}.assess(
      x, uncertainty_.intervals(), novelty, ahead_s);
}

double PosteriorAxis::predict_with_gradient(std::span<const double> x,
                                            std::span<double> gradient) const {
  if (has_scale_) {
    return ServedAxis<FunctionMix>{scaling_, terms(), mixture_.function()}.predict_with_gradient(
        x, gradient);
  }
  std::ranges::fill(gradient, 0.0);
  return predict(x);
}

Status PosteriorAxis::status() const {
  const auto centres = static_cast<int>(features_.basis().size());
  return {
      .buffer = centres, .support_vectors = centres, .ready = posterior_.ready(), .tally = tally_};
}

std::vector<Coefficient> PosteriorAxis::coefficients() const {
  std::vector<Coefficient> list;
  for (std::size_t k = 0; has_scale_ && k < terms().size(); ++k) {
    list.push_back({.term = terms().text(k),
                    .value = scaling_.target.scale * mixture_.function().term_weight(k) /
                             scaling_.term_scale[k],
                    .error = posterior_.error(k + 1)});
  }
  return list;
}

Snapshot PosteriorAxis::snapshot() const {
  Snapshot copy{.name = {}, .scaling = scaling_, .function = mixture_.function(), .known = known_};
  uncertainty_.refresh(copy);
  return copy;
}

void PosteriorAxis::refresh(Snapshot& copy) const {
  const FunctionMix& served = mixture_.function();
  copy.scaling = scaling_;
  copy.function.limits = served.limits;
  copy.function.term_ranges = served.term_ranges;
  copy.function.nominal = served.nominal;
  for (std::size_t k = 0; k < served.members.size(); ++k) {
    copy.function.members[k].share = served.members[k].share;
    copy.function.members[k].function.assign(served.members[k].function);
  }
  copy.known->samples.assign(known_.samples);
  copy.known->density.assume(known_.density.sums());
  uncertainty_.refresh(copy);
}

Snapshot PosteriorAxis::trained(std::string name) const {
  return {.name = std::move(name),
          .scaling = scaling_,
          .function = mixture_.function(),
          .half_width = uncertainty_.half_width(),
          .known = known_};
}

void PosteriorAxis::expect_vehicle(std::vector<double> coefficients) {
  prior_ = std::move(coefficients);
  std::ranges::rotate(prior_, prior_.end() - 1);  // the term 1 is the first feature
  mixture_.expect_vehicle();
}

std::vector<StoredPastModel> PosteriorAxis::past_models() const {
  PastVehicles all = past_;
  all.leave(posterior_, last_s_, features_.groups());
  std::vector<StoredPastModel> list;
  for (const PastVehicle& one : all.vehicles()) {
    SampleSums sums = one.posterior.sums();
    sums.tell_anew(prior_);
    list.push_back(
        {.info = one.info, .rows_per_sample = one.rows_per_sample, .sums = sums.numbers()});
  }
  return list;
}

void PosteriorAxis::set_past_models(std::vector<StoredPastModel> models) {
  const std::size_t terms = features_.terms_end();
  const std::size_t numbers = SampleSums::count_numbers(terms);
  require(
      models.size() <= past_.most(), "past models",
      std::to_string(models.size()) + " given; the settings keep " + std::to_string(past_.most()));
  std::vector<double> unexpected = prior_;
  std::ranges::transform(prior_, unexpected.begin(), std::negate<>{});
  for (const StoredPastModel& one : models) {
    const std::string name = "number " + std::to_string(one.info.number);
    require(one.sums.size() == numbers, "past models",
            name + " holds " + std::to_string(one.sums.size()) +
                " sums; 'learner = posterior' needs " + std::to_string(numbers) + ", of " +
                std::to_string(terms) + " terms");
    SampleSums sums(terms);
    sums.assign(terms, one.sums);
    sums.tell_anew(unexpected);
    require(past_.add(one.info, sums, one.rows_per_sample, features_.groups()), "past models",
            name + " holds sums of no samples");
  }
}

void PosteriorAxis::resume_from(const Snapshot& trained, double t) {
  require(trained.known.has_value(), "known",
          "is missing; 'learner = posterior' goes on from models with known places");
  const SampleStore& places = trained.known->samples;
  const double spread = std::isfinite(trained.half_width)
                            ? kPosterior.deviations_per_width * trained.half_width
                            : kPosterior.unknown_spread * trained.scaling.target.scale;
  std::vector<double> z(places.dimension()), other(z);
  for (std::size_t k = 0; places.size() > 0 && k < kPosterior.places_told; ++k) {
    const std::size_t i = k % places.size();
    places.get(i, z);
    places.get((i + k / places.size()) % places.size(), other);
    std::ranges::transform(z, other, z.begin(), [](double a, double b) { return 0.5 * (a + b); });
    const ScaledInput x = trained.scaling.input.invert(z);
    const double value = trained.predict(terms(), as_span(x));
    for (const double y : {value - spread, value + spread}) {
      learn(
          {{.x = as_span(x), .y = y, .left = y - expected(as_span(x)), .t = t}, Likelihood::gauss});
    }
    if (posterior_.wants_solve()) {
      settle(posterior_, features_.groups());
      change_scale();
    }
  }
  tally_ = {};
}

void PosteriorAxis::visit(Archive& archive) {
  archive.part("features", features_);
  archive.part("posterior", posterior_);
  archive.part("screen", screen_);
  archive.part("past vehicles", past_);
  archive.list(prior_, terms().size() + 1, [&](double& one) { archive.number(one); });
  if (archive.loading() && !prior_.empty()) {
    mixture_.expect_vehicle();
  }
  uncertainty_.visit(archive);
  archive.number(last_s_);
  archive.number(far_s_);
  archive.flag(trusted_last_);
  archive.part("tally", tally_);
  if (archive.loading()) {
    know_centres();
  }
  archive.flag(has_scale_);
  if (has_scale_) {
    scaling_.visit(archive, features_.units().dimension(), terms().size());
    archive.part("mixture", mixture_);
    archive.number(certain_.low);
    archive.number(certain_.high);
    if (archive.loading()) {
      assign_members();
    }
  }
}

std::size_t PosteriorAxis::bytes(std::size_t inputs, std::size_t terms,
                                 const OnlineSvrSettings& settings) {
  const std::size_t centres = centres_of(settings);
  return sizeof(PosteriorAxis) + Posterior::bytes(centres + terms + 1, terms + 1) +
         RowScreen::bytes(inputs, terms + 1) +
         PastVehicles::bytes(terms + 1, centres + terms + 1, settings.past_models()) +
         centres * (centres + 1) / 2 * sizeof(double) + 2 * SampleStore::bytes(inputs, centres) +
         KernelDensity::bytes(inputs, centres) + Mixture::bytes(inputs, terms, centres, settings);
}

}  // namespace kelpie
