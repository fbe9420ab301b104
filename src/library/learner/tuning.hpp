// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace kelpie {

/// The behavioural constants of the learner of one axis, by mechanism, with unit and origin. Sizes
/// of windows and blocks stand with their arrays. "Training rows" are the training rows of the real
/// and simulated logs of docs/measured/accuracy.md; "by hand" means without a recorded measurement.
struct OnlineTuning {
  /// ErrorAlarm: CUSUM of |error| in usual errors.
  struct Alarm {
    double clip = 5.0;   ///< largest contribution of one sample [usual errors]: by hand
    double drift = 2.0;  ///< subtracted per sample [usual errors]: by hand
  } alarm;

  /// ChangeDetector; docs/method/learner.md, "When the vehicle changes": training rows.
  struct Change {
    double alarm = 20.0;             ///< at least seven bad samples in a row [usual misfits]
    int burn_in = 20;                ///< samples a challenger learns before the comparison
    double margin = 0.5;             ///< required advantage per sample [usual misfits]
    double win = 60.0;               ///< lead that confirms a change [usual misfits]
    double expected_win = 30.0;      ///< the same after an alert of another axis [usual misfits]
    double loss = -40.0;             ///< lead that dismisses a challenger [usual misfits]
    int patience = 500;              ///< samples of a comparison
    std::size_t least_misfits = 50;  ///< residuals before the usual misfit is known: by hand
    std::size_t misfit_every = 16;   ///< residuals between two medians: by hand
  } change;

  /// AdaptiveSvr: long tasks; chosen by the time of an update, docs/measured/performance.md.
  struct Task {
    int caught_up = 2;      ///< samples per update, one more than can arrive
    int recall_slices = 3;  ///< per update, since predictions are poor until the recall is done
  } task;

  /// PastModels; method/learner.md: scenarios/returns.toml, seed 1, and training rows of Dagon.
  struct Memory {
    double alarm = 10.0;              ///< at least four bad samples in a row [mean errors]
    std::int64_t settled = 192;       ///< samples before the usual error is known
    std::int64_t keep_every = 64;     ///< samples between two copies of the model in service
    double window = 500.0;            ///< samples of the mean error
    std::int64_t trial_length = 200;  ///< samples of a trial
    std::int64_t same_after = 1024;   ///< age of a grown model that equals a past model [samples]
    double least_error = 1e-9;        ///< usual error of a noiseless stream [standard deviations]
    double same_place = 0.99;         ///< κ_SE of two samples at one place: by hand
  } memory;

  /// ModelTrial; docs/method/learner.md as above. In the past model's usual errors.
  struct Trial {
    double margin = 0.5;  ///< required advantage per sample
    double lead = 15.0;   ///< required advantage in all: at least four samples
    double fits = 2.0;    ///< largest mean error
  } trial;

  /// Committee and its SparseRegression members; method/committee.md: 36 axes of nine vehicles.
  struct Members {
    std::size_t precise_centres = 300;
    double precise_gamma = 0.1;        ///< γ for six inputs
    double precise_new_place = 0.01;   ///< fraction of a kernel function's squared norm
    double precise_ridge = 0.01;       ///< noise variance relative to the kernel part's
    double precise_term_prior = 0.02;  ///< samples
    double physics_term_prior = precise_term_prior;  ///< samples
    double least_prior = 1e-3;  ///< of `line`, against a singular fit [samples]: by hand
    std::size_t memory_centres = 150;
    double memory_gamma = 0.2;       ///< γ for six inputs
    double gamma_inputs = 6.0;       ///< γ is proportional to 1/√inputs
    std::size_t slice = 6;           ///< samples relearned per update: by the time of an update
    int rounds = 2;                  ///< of relearning after a change
    double huber = 2.5;              ///< usual errors of full weight: by hand
    double imitated = 2000.0;        ///< samples that an imitated function stands for: by hand
    std::int64_t ignored_first = 5;  ///< errors of the first samples, uninformative: by hand
    std::size_t error_least = 30;    ///< errors before the usual error is known: by hand
    std::size_t error_every = 16;    ///< errors between two medians: by hand
    double kept = 300.0;             ///< independent samples behind the terms' weights, at a change
    double nominal_known = 20.0;     ///< samples behind weights known beforehand, committee.md
    double nominal_share = 0.5;      ///< first share of `line` with such weights, beyond the usual
    double caution = 0.5;            ///< κ of a member's disagreement, method/committee.md
    /// Shares before the first errors, relative to each other, in the order of the members: the
    /// simpler a member, the less a few samples mislead it.
    std::array<double, 6> first_shares{1.0, 0.4, 1.0, 0.2, 1.5, 0.5};
  } members;

  /// ErrorCorrelation.
  struct Evidence {
    double first = 10.0;        ///< rows per independent sample, before they are known
    std::int64_t least = 64;    ///< errors before they are known: by hand
    std::int64_t every = 8;     ///< errors between two looks: by hand
    double keep = 0.9995;       ///< per error: a memory of 2,000 errors, by hand
    double least_alike = 1e-3;  ///< smallest autocorrelation
    double clip = 3.0;          ///< largest error [usual errors]: by hand
  } evidence;

  /// MemberShares and CalibrationSlope; docs/method/committee.md as above.
  struct Shares {
    double learning_rate = 5.0;  ///< η
    double keep = 0.98;          ///< λ per block: a memory of 50 blocks
    double least_share = 1e-9;
    double clip = 10.0;         ///< largest error of one sample [standard deviations]
    double least_usual = 1e-6;  ///< smallest usual loss [variances]
    double slope_keep = 0.999;  ///< λ per sample: a memory of 1,000 samples
    double slope_prior = 10.0;  ///< weight of slope 1 [samples]
    double slope_clip = 3.0;    ///< largest value of one sample [standard deviations]
  } shares;

  /// SeenRange.
  struct Range {
    double margin = 0.1;        ///< of targets, added on either side, of the width: by hand
    double term_margin = 0.5;   ///< of physics terms, the same: docs/method/committee.md
    double early_margin = 1.0;  ///< the same for few targets [standard deviations]: by hand
  } range;

  /// Disturbance; docs/method/uncertainty.md: training rows, of little influence.
  struct Disturbances {
    double lambda = 0.999;     ///< weight of a sample relative to the next
    double replaced = 10.0;    ///< forgetting per sample is limited to this multiple of its gain
    double least_known = 0.1;  ///< prior of a weight [samples]
    double far = 10.0;         ///< usual errors of a suspect target
    double heaviest = 10.0;    ///< usual errors of full weight
    double around = 3.0;  ///< usual errors around the range of f, y₋₁ and 2 y₋₁ − y₋₂
    double outside = 0.25;       ///< largest excess over the targets' range, of the range
    double absurd = 10.0;        ///< ranges outside the range where a target is clipped
    double next = 1.5;           ///< usual steps up to the next sample
    double counted_step = 3.0;   ///< usual steps where a step is clipped
    double step_pace = 0.05;     ///< rate of the usual step per sample
    double trust_memory = 50.0;  ///< suspect targets
  } disturbance;

  /// ConformalInterval; docs/method/uncertainty.md: windows of 100, 250 and 500 on training rows.
  struct Interval {
    double stretch = 500.0;       ///< samples over which the best expert may change (section 3)
    std::size_t min_errors = 30;  ///< errors before an interval: by hand
  } interval;

  /// RecursiveLeastSquares: by hand.
  struct LeastSquares {
    int most_velocities = 6;
    std::int64_t weak_look_every = 16;  ///< samples between two searches for weak terms
  } least_squares;
};

inline constexpr OnlineTuning kOnline{};

}  // namespace kelpie
