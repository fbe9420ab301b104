// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace kelpie {

/// Constants of the posterior, with unit and source.
inline constexpr struct PosteriorTuning {
  double huber = 3.0;     ///< deviations of an error that bound its influence; by hand
  double freedom = 10.0;  ///< ν of Student's t (Lange et al. 1989); chosen on ../data/vehicles
  double most_deviations = 4.0;    ///< of an error in τ; by hand
  double first_rows = 10.0;        ///< rows before the first solve; by hand
  double least_deviation = 1e-12;  ///< of targets, per mean: rounding
  double rows_per_feature = 0.04;  ///< rows between solves, per feature; from 0.01 to 0.04 by hand
  double recalled_rows = 100.0;    ///< without a solve after a recall; by hand
  double widths_growth = 1.1;      ///< of rows between steps of the evidence; by hand
  double young_rows = 200.0;       ///< up to which a solve has more rounds; by hand
  int young_rounds = 3;
  double hyperprior = 0.01;        ///< h of groups of terms; chosen on lab/random_vehicles.py
  double kernel_hyperprior = 0.3;  ///< h of the kernel; chosen on ../data/vehicles
  double kernel_precision = 3.0;   ///< α₀ of the kernel; chosen on lab/random_vehicles.py
  double noise_prior = 0.1;        ///< σ² of one sample before all others; by hand
  double least_freedom = 0.3;      ///< share of samples that the noise keeps; by hand
  double least_noise = 1e-8, most_noise = 2.0;  ///< σ² per variance of the target
  double least_precision = 1e-4, most_precision = 1e8;
  double flat = 1e-6;     ///< precision of the constant
  double gamma = 0.1;     ///< of κ on six inputs in deviations; chosen on ../data/vehicles
  double novelty = 0.02;  ///< squared left-over norm of a new centre; as above
  /// Shares of posterior, terms, svr and mean before the first losses; by hand.
  std::array<double, 4> first_shares{0.3, 0.4, 0.15, 0.15};
  std::array<double, 4> first_shares_of_known{0.1, 0.1, 0.1, 0.7};  ///< likewise
  double certain = 3.0;          ///< standard errors of an effect; chosen on lab/random_vehicles.py
  double block = 2.0;            ///< independent samples of a block of losses; by hand
  int buffer_per_centre = 3;     ///< samples of the setting `buffer`; by hand
  std::int64_t slice = 300'000;  ///< numbers of a solve in one update; by hand
  double outgrown = 1.5;         ///< growth of an input's deviation that moves the kernel; by hand
  double least_samples = 80.0;   ///< independent, of all rows; chosen on lab/random_vehicles.py
  double usual = 4.0;            ///< times the usual surprise that a row counts, at most; by hand
  double least_usual = 0.25;     ///< likewise, of the usual surprise; by hand
  double unexplained = 0.8;  ///< share of the target's variance by which nothing is known; by hand
  double most_unknown = 20.0;  ///< s² of a row that waits, in variances of the target; by hand
  double set_off = 1e3;        ///< s² at which a vehicle at rest sets off, likewise; by hand
  double far = 10.0;           ///< deviations of a velocity beyond which a row counts less; by hand
  double garbage_s = 36.0;     ///< longest garbage of a sensor [s]; by hand
  double longest_step_s = 2.0;  ///< of two rows without a gap [s]; by hand
  double surprise = 16.0;       ///< e²/(σ² + s²) beyond which a row waits; by hand
  double patience = 4.0;    ///< times the longest garbage, of rows that no terms explain; by hand
  double explained = 0.05;  ///< nats a row by which a restart explains more than the mean; by hand
  double calm_s = 2.0;      ///< after which rows that wait are judged [s]; by hand
  double most_distance = 0.5;  ///< Cook's, of rows that are learned; chosen on garbage of ../data
  double least_changed = 0.2;  ///< Cook's, of rows of another vehicle; chosen on ../data/plants
  double coherence = 0.6;      ///< Σ e e'/Σ e² of neighbours, beyond that of two equal; by hand
  double first_restart_s = 10.0, restart_s = 20.0;  ///< [s]; by hand
  double ahead_s = 2.0;                      ///< least age of weights that are scored [s]; by hand
  double nats = 14.0, nats_at_start = 20.0;  ///< of a restart that wins; lab/random_vehicles.py
  double nats_on_probation = 3.0;            ///< of rows that wait; by hand
  double kept_on_probation = 10.0;           ///< independent samples of before; by hand
  double ahead_on_probation_s = 0.5;         ///< least age of weights that are scored [s]
  double nats_per_row = 0.7;                 ///< likewise; by hand
  double most_ratio = 2.0;                   ///< logarithm of a ratio of errors; by hand
  double least_error = 0.02;     ///< square of an error, in variances of the noise; by hand
  double most_correlated = 0.2;  ///< τ of a young posterior, per row; by hand
  double kept = 50.0;  ///< independent samples of before a change; from 50, 150, 1,000 on ../data
  double samples_per_term = 10.0;     ///< independent, of a past vehicle: a rule of thumb; by hand
  std::size_t places_told = 1000;     ///< of a trained model; from 300 to 3,000 on a plant
  double deviations_per_width = 0.5;  ///< of errors, per half an interval of 90 %; by hand
  double unknown_spread = 0.3;        ///< of errors, per deviation of the target; by hand
  /// Share of the evidence that is enough after another axis' vehicle is back; chosen on a plant.
  double alerted = 0.2;
  int rows_per_update = 4;  ///< rows learned later; by hand
} kPosterior;

}  // namespace kelpie
