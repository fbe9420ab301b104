// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace kelpie {

/// The behavioural constants of the room model, each with unit and source. "By hand": chosen by
/// hand; no measurement recorded.
inline constexpr struct ModelTuning {
  double almost = 0.999;  ///< of a step, which is over: stamps are rounded, by 0.2 µs since 1970

  /// The scale of the paper's learner (model/first_scale.hpp).
  struct Scale {
    std::size_t remembered = 1000;  ///< samples; later samples fade earlier ones; by hand
    double far = 10.0;              ///< spreads of an implausible sample; by hand
    double beyond = 3.0;            ///< largest magnitudes of an implausible sample: a command at
                                    ///< a third of its range may take the whole
    std::int64_t held_look = 16;    ///< held-back samples between two looks for a scale; by hand
    std::size_t held_slice = 8;     ///< held-back samples learned per update; by hand
  } scale;

  /// A vehicle that sets off (model/first_moves.hpp).
  struct FirstMoves {
    double far = 10.0;       ///< standard deviations of a command that moves; by hand
    double explained = 0.5;  ///< of the variance, of a vehicle that is known; by hand
  } first_moves;

  /// The equations of motion of a vehicle (model/steady_part.hpp).
  struct Steady {
    double prior = 0.1;          ///< samples per coefficient; by hand
    double step_s = 0.2;         ///< s, least step: a fifth of the fastest vehicle's time constant
    double jump = 4.0;           ///< usual accelerations of a cut in the log; by hand
    double noisy_jump = 8.0;     ///< standard deviations of an unexplained change, of a cut, too
    double clip = 3.0;           ///< of these deviations: more tells nothing of the noise
    double memory = 1000.0;      ///< samples or steps, mean of errors; by hand
    double block_s = 10.0;       ///< s, blocks of errors that give their duration; by hand
    double block_memory = 50.0;  ///< blocks; by hand
    double products = 0.1;     ///< of accelerations; method/open_loop.md: from 0.01, 0.03, 0.1, 0.3
    double most_alike = 0.98;  ///< correlation of two errors; less certain is what is larger
    double match = 0.02;       ///< of the logarithm of the gain, per unit of correlation
    double longest_window_s = 20.0;   ///< s, twice the window; docs/method/open_loop.md
    std::int64_t few = 20;            ///< weight of errors before a change, in values; by hand
    std::int64_t steps_per_term = 3;  ///< before weights are known; by hand
    double before_s = 25.0;           ///< s, weight of steps before a change; method/open_loop.md
  } steady;

  /// ChangeMonitor; docs/method/posterior.md, Changes: a prototype on training rows of 24 streams.
  struct Change {
    double step_s = 0.24;            ///< s between two rows that count: from 0.2, 0.24
    std::size_t most_terms = 64;     ///< beyond, terms without products of commands, for the cost
    double prior = 1.0;              ///< of a term without effect [samples]; by hand
    std::size_t least_errors = 64;   ///< before the usual error is known; by hand
    std::size_t scatter_every = 16;  ///< errors between two medians; by hand
    std::size_t octave_errors = 32;  ///< of effects of one octave, before their errors are known
    std::size_t octave_every = 8;    ///< such errors between two medians; by hand
    std::uint64_t error_every = 4;   ///< rows per error of the usual error: 200 s in its window
    double clip_errors = 3.0;        ///< usual errors, largest in the autocorrelation
    double start_every_s = 10.0;     ///< s between two starts; by hand
    double life_s = 40.0;            ///< s, of every second start; by hand
    int doublings = 4;               ///< of the life, up to 640 s; by hand
    double longest_life_s = 640.0;   ///< s; by hand
    double deviation = 0.5;          ///< of a size; 0.3 gives the same
    double named_deviation = 0.1;    ///< of a size that a diagnosis names; 0 and 0.5 on a catamaran
    double clip_nats = 1.5;          ///< largest evidence of a sample; from 0.8, 1.5, 3
    double enough = 40.0;            ///< nats; without a change up to 39
    double over_usual = 2.0;         ///< times the largest evidence of former starts; from 1.5, 2
    double clear = 0.45;             ///< nats per sample: 40 % of the errors' variance is left
    double likely = 0.3;             ///< the same of one likely cause, with enough over constants
    double constant_errors = 10.0;   ///< usual errors, deviation of a constant error; by hand
    double over_constant = 5.0;      ///< nats over constant errors: very strong (Kass & Raftery)
    double usual_memory_s = 1800.0;  ///< s, of this evidence; by hand
    double samples_per_term = 5.0;   ///< independent samples of a vehicle that is known; by hand
    double alike = 0.8;              ///< share of the largest evidence that tells as much; by hand
    double lone_share = 0.9;         ///< of the likelihood of all causes, of one that is enough
    double main_share = 0.5;         ///< the same, of a cause without which no change is likely
    double least_gain = 0.05;        ///< of a command; 0 would leave no way back
    double most_gain = 3.0;          ///< of a command; by hand
    double gain_step = 0.01;         ///< between two gains tried; by hand
    double settle_s = 60.0;          ///< s in which coefficients follow a change; by hand
    double move_every_s = 1.0;       ///< s between two steps; by hand
    double probation_s = 120.0;      ///< s in which a change may be withdrawn; by hand
    double huber = 2.5;              ///< usual errors of full weight; by hand
    double kept = 300.0;             ///< independent samples behind the weights, at a change
  } change;

  /// Practice of rollouts (model/open_loop_practice.hpp).
  struct Practice {
    std::size_t stretches = 24;  ///< that count; docs/method/open_loop.md: from 12, 16, 24, 32
    double assumed = 0.5;    ///< stretches that say nothing against half and half, and the change
    std::size_t few = 3;     ///< stretches before a change of the vehicle that count; by hand
    double coverage = 0.9;   ///< of the errors, within the bands
    double least_off = 0.1;  ///< of the errors scored: not noise of the measurement; by hand
  } practice;

  /// Rollouts (model/rollout.hpp).
  struct Rollout {
    double diffusion = 0.5;  ///< most growth of errors beyond practised ages, as a power of the
                             ///< age: a random walk's
    double beyond = 0.05;    ///< of the range seen, outside which an input is new; by hand
    double leeway = 0.5;     ///< of the range seen, bound of velocities; by hand
    double probe = 1e-4;     ///< of the range seen, step of numerical slopes; by hand
  } rollout;

  /// The limit of the work of an update (model/work_limit.hpp, docs/measured/performance.md).
  struct Work {
    double numbers = 10e6;      ///< per update: 5 ms at 0.5 ns per number (measured/performance.md)
    std::size_t axes = 3;       ///< up to so many axes; more axes add work in proportion
    std::size_t places = 901;   ///< up to so many samples; more samples add work squared
    std::int64_t growth = 200;  ///< part of the limit added per rejected sample: half a percent
    std::int64_t decay = 8000;  ///< part of the addition lost per update; by hand
    std::int64_t most = 20;     ///< times the first limit: 100 ms; by hand, 7 in the hardest log
  } work;
} kModelTuning;

}  // namespace kelpie
