// SPDX-License-Identifier: Apache-2.0
#include "alignment/alignment_search.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "alignment/tuning.hpp"
#include "motion/signal_names.hpp"

namespace kelpie {
namespace {

constexpr const auto& kSearch = kAlignmentTuning.alignment;

template <typename Change>
AlignmentGuess with_each(AlignmentGuess guess, const Change& change) {
  std::ranges::for_each(guess.actuators, change);
  return guess;
}

template <typename Change>
AlignmentGuess with_one(AlignmentGuess guess, std::size_t k, const Change& change) {
  change(guess.actuators[k]);
  return guess;
}

// Value at rest of a command that never changes its sign: servo pulses [µs], percent, shares.
std::optional<double> usual_neutral(double lowest, double highest) {
  if (are_servo_pulses(lowest, highest)) {
    return kNeutralPulseUs;
  }
  for (const double full : {1.0, 100.0}) {
    if (lowest >= 0.0 && highest <= full && highest > 0.5 * full) {
      return 0.5 * full;
    }
  }
  return std::nullopt;
}

}  // namespace

AlignmentSearch::AlignmentSearch(AlignmentFit& fit, double rate_hz, const Alignment& known)
    : fit_(fit),
      rate_hz_(rate_hz),
      known_{.shift = 0, .actuators = AlignmentGuess::of(known, fit.commands().size()).actuators} {
  const double longest =
      std::min(kSearch.longest_lag * fit.rows().duration_s(), kSearch.longest_lag_s);
  lags_s_.push_back(0.0);
  for (double lag_s = 0.5 / rate_hz; lag_s <= longest; lag_s *= 2.0) {
    lags_s_.push_back(lag_s);
  }
  for (const std::size_t command : fit.commands()) {
    const auto [low, high] = std::ranges::minmax(fit.rows().inputs[command]);
    lowest_.push_back(low * fit.rows().largest[command]);
    range_.push_back((high - low) * fit.rows().largest[command]);
  }
}

void AlignmentSearch::improve(AlignmentResult& found) {
  const Scored rest = pulses_at_rest(scored(known_));
  AlignmentGuess before = AlignmentGuess::of(found.alignment, fit_.commands().size());
  if (before == known_ && rest.guess != known_) {
    found.alignment.actuators = rest.guess.actuators;
    before = rest.guess;
  }
  known_ = rest.guess;
  const Scored present = scored(std::move(before));
  const Scored resting = neutral(rest);
  std::vector<Scored> better{refined(each_command(lagged(resting)))};
  const Scored late = shifted(resting);
  if (late.guess != resting.guess) {
    const Scored both = refined(each_command(late));
    if (both.errors.mean() <= better.front().errors.mean()) {
      better = {both, late};
    }
  }
  decide(present, better, found);
}

AlignmentSearch::Scored AlignmentSearch::scored(AlignmentGuess guess) {
  Eigen::ArrayXXd errors = fit_.log_errors(guess);
  return {std::move(guess), std::move(errors)};
}

AlignmentSearch::Scored AlignmentSearch::step(const Scored& from, const Guesses& guesses,
                                              Folds counted) {
  std::vector<Scored> tried{from};
  for (const AlignmentGuess& guess : guesses) {
    if (std::ranges::find(tried, guess, &Scored::guess) == tried.end()) {
      tried.push_back(scored(guess));
    }
  }
  return simplest(std::move(tried), counted);
}

// The simplest guess within one standard error of the best, if clearly better than the first.
AlignmentSearch::Scored AlignmentSearch::simplest(std::vector<Scored> tried, Folds counted) {
  std::vector<Eigen::ArrayXXd> errors;
  std::ranges::transform(tried, std::back_inserter(errors), &Scored::errors);
  const std::size_t chosen = simplest_of_best(errors, counted);
  const bool is_better = FoldEvidence(errors.front() - errors[chosen], counted).is_clear();
  return std::move(tried[is_better ? chosen : 0]);
}

// The best guess; for numbers of which one is no simpler than the other.
AlignmentSearch::Scored AlignmentSearch::descend(Scored from, const Guesses& guesses) {
  for (const AlignmentGuess& guess : guesses) {
    Scored next = scored(guess);
    if (next.errors.mean() < from.errors.mean()) {
      from = std::move(next);
    }
  }
  return from;
}

// By convention, and unless the log clearly says otherwise: where thrust is linear in the pulse, a
// constant force does as well, but is no thruster's.
AlignmentSearch::Scored AlignmentSearch::pulses_at_rest(Scored from) {
  AlignmentGuess usual = from.guess;
  for (std::size_t k = 0; k < range_.size(); ++k) {
    const double highest = lowest_[k] + range_[k];
    const double side = std::min(kNeutralPulseUs - lowest_[k], highest - kNeutralPulseUs);
    if (are_pulses_about_rest(lowest_[k], highest) && side >= kSearch.pulse_side * range_[k] &&
        usual.actuators[k].none()) {
      usual.actuators[k].neutral = kNeutralPulseUs;
    }
  }
  if (usual == from.guess) {
    return from;
  }
  const Scored at_rest = scored(std::move(usual));
  return FoldEvidence(at_rest.errors - from.errors, Folds::middle).is_clear() ? from : at_rest;
}

AlignmentSearch::Scored AlignmentSearch::neutral(Scored from) {
  AlignmentGuess all = from.guess;
  for (std::size_t k = 0; k < range_.size(); ++k) {
    const std::optional<double> rest = usual_neutral(lowest_[k], lowest_[k] + range_[k]);
    if (rest && range_[k] > 0.0 && known_.actuators[k].none()) {
      all.actuators[k].neutral = *rest;
    }
  }
  if (all == from.guess) {
    return from;
  }
  const AlignmentGuess usual = all;
  from = step(from, {usual}, Folds::middle);
  for (std::size_t k = 0; k < range_.size() && from.guess != usual; ++k) {
    from =
        step(from,
             {with_one(from.guess, k,
                       [&](Actuator& actuator) { actuator.neutral = usual.actuators[k].neutral; })},
             Folds::all);
  }
  return from;
}

AlignmentSearch::Scored AlignmentSearch::shifted(const Scored& from) {
  const int farthest =
      static_cast<int>(std::min(kSearch.farthest_s * rate_hz_, kSearch.most_rows_away));
  const int by = std::max(1, (farthest + kSearch.steps_per_side - 1) / kSearch.steps_per_side);
  Guesses guesses;
  for (int shift = by; shift <= farthest; shift += by) {
    for (const int sign : {1, -1}) {
      guesses.push_back(from.guess);
      guesses.back().shift = sign * shift;
    }
  }
  return step(from, guesses, Folds::middle);
}

// One lag of all actuators.
AlignmentSearch::Scored AlignmentSearch::lagged(const Scored& from) {
  Guesses guesses;
  for (const double lag_s : lags_s_) {
    guesses.push_back(with_each(from.guess, [&](Actuator& actuator) { actuator.lag_s = lag_s; }));
  }
  Scored together = step(from, guesses, Folds::middle);
  for (const double factor : kSearch.refining) {
    const auto by = [&](double times) {
      return with_each(together.guess, [&](Actuator& actuator) { actuator.lag_s *= times; });
    };
    together = descend(std::move(together), {by(factor), by(1.0 / factor)});
  }
  return together;
}

// A second turn for actuators found beside wrong ones.
AlignmentSearch::Scored AlignmentSearch::each_command(Scored from) {
  std::vector<bool> settled(range_.size());
  for (int turn = 0; turn < 2; ++turn) {
    for (std::size_t k = 0; k < range_.size(); ++k) {
      const AlignmentGuess before = from.guess;
      if (range_[k] > 0.0 && !settled[k]) {
        from = command(std::move(from), k);
      }
      settled[k] = from.guess == before;
    }
  }
  return from;
}

AlignmentSearch::Scored AlignmentSearch::command(Scored from, std::size_t k) {
  const auto actuator = [&] { return from.guess.actuators[k]; };
  const auto with = [&](auto change) { return with_one(from.guess, k, change); };
  Guesses guesses;
  for (const double lag_s : lags_s_) {
    guesses.push_back(with([&](Actuator& changed) { changed.lag_s = lag_s; }));
  }
  from = step(from, guesses, Folds::all);

  // Part of a lag may have been a rate.
  const std::vector<double> lags_s{actuator().lag_s, 0.5 * actuator().lag_s, 0.0};
  guesses.clear();
  double rate = range_[k];
  for (int i = 0; i < kSearch.rate_halvings; ++i, rate *= 0.5) {
    for (const double lag_s : lags_s) {
      guesses.push_back(with([&](Actuator& changed) {
        changed.rate = rate;
        changed.lag_s = lag_s;
      }));
    }
  }
  from = step(from, guesses, Folds::all);

  return delayed(from, k);
}

// Part of a lag may have been a delay, if no other lag does as well. Up to the first delay that
// explains less: a longer delay that explains more again goes with an oscillation of the vehicle.
AlignmentSearch::Scored AlignmentSearch::delayed(const Scored& from, std::size_t k) {
  std::vector<Scored> tried{from};
  for (const double factor : kSearch.refining) {
    tried.front() = refined(std::move(tried.front()), k, &Actuator::lag_s, factor);
  }
  double delay_s = 0.5 / rate_hz_;
  bool goes_on = true;
  for (int i = 0; i < kSearch.delay_doublings && delay_s <= Alignment::kMostS && goes_on; ++i) {
    goes_on = false;
    for (const double of_lag_s : {0.0, delay_s}) {
      tried.push_back(scored(with_one(from.guess, k, [&](Actuator& changed) {
        changed.delay_s = delay_s;
        changed.lag_s = std::max(changed.lag_s - of_lag_s, 0.0);
      })));
      const FoldEvidence gain(from.errors - tried.back().errors);
      goes_on = goes_on || gain.mean >= -gain.error;
    }
    delay_s *= 2.0;
  }
  Scored best = simplest(std::move(tried), Folds::all);
  return best.guess.actuators[k].delay_s == 0.0 ? from : best;
}

AlignmentSearch::Scored AlignmentSearch::refined(Scored from) {
  for (const double factor : kSearch.refining) {
    for (double Actuator::*const number : {&Actuator::lag_s, &Actuator::rate}) {
      for (std::size_t k = 0; k < range_.size(); ++k) {
        from = refined(std::move(from), k, number, factor);
      }
    }
  }
  return from;
}

AlignmentSearch::Scored AlignmentSearch::refined(Scored from, std::size_t k,
                                                 double Actuator::*number, double factor) {
  if (from.guess.actuators[k].*number == 0.0) {
    return from;
  }
  const auto by = [&](double times) {
    return with_one(from.guess, k, [&](Actuator& changed) { changed.*number *= times; });
  };
  return descend(from, {by(factor), by(1.0 / factor)});
}

// Where a kernel describes the vehicle better than the terms of least squares, the terms may like
// commands that merely go with the vehicle; elsewhere the kernel, of fewer rows, has no say.
bool AlignmentSearch::kernel_agrees(const Scored& present, const Scored& other) {
  const Eigen::ArrayXXd before = fit_.log_kernel_errors(present.guess);
  return before.mean() >= present.errors.mean() ||
         !FoldEvidence(fit_.log_kernel_errors(other.guess) - before).is_clear();
}

void AlignmentSearch::decide(const Scored& present, const std::vector<Scored>& better,
                             AlignmentResult& found) {
  const bool none = present.guess == known_;
  const std::string against = none ? "without" : "with the one before";
  const auto evidence = [&](const Scored& other) {
    return FoldEvidence(present.errors - other.errors, Folds::middle).percent() +
           " of what is unexplained " + against + ", on " + std::to_string(AlignmentFit::kFolds) +
           " folds of the training rows";
  };
  for (const Scored& other : better) {
    const FoldEvidence gain(present.errors - other.errors, Folds::middle);
    if (other.guess != present.guess && gain.is_clear() && kernel_agrees(present, other)) {
      found.alignment.rows = other.guess.shift;
      found.alignment.lag_s = other.guess.shift / rate_hz_;
      found.alignment.actuators = other.guess.actuators;
      if (std::ranges::all_of(other.guess.actuators, &Actuator::none)) {
        found.alignment.actuators.clear();
      }
      found.gain = gain.explained();
      found.why = "this explains " + evidence(other);
      return;
    }
  }
  const Scored& best = better.front();
  const bool nothing = best.guess == present.guess || best.errors.mean() >= present.errors.mean();
  found.why =
      nothing ? "no shift and no actuator explains more"
              : "no shift and no actuator is clearly better; the best explains " + evidence(best);
}

}  // namespace kelpie
