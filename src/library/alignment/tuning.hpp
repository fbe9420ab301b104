// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace kelpie {

/// The behavioural constants of the room alignment, each with unit and source. "By hand": chosen by
/// hand; no measurement recorded.
inline constexpr struct AlignmentTuning {
  /// Search of an alignment (alignment/alignment.hpp). Grids are by halves and doubles, since a
  /// factor of two in a time constant costs a few percent of the error; a refinement follows.
  struct Alignment {
    double farthest_s = 1.0;       ///< lags searched, ±; by hand
    double most_rows_away = 1e6;   ///< bound of a lag in rows; by hand
    int steps_per_side = 10;       ///< lags tried on either side of 0; by hand
    double pulse_side = 0.25;      ///< of the range of pulses, on either side of rest
    double longest_lag = 0.02;     ///< of the duration of the rows: an actuator's lag
    double longest_lag_s = 120.0;  ///< s, of an actuator; by hand
    /// √2, √√2: between values tried of a lag or a rate; by hand
    std::array<double, 2> refining{1.4142135623730951, 1.189207115002721};
    int rate_halvings = 8;                  ///< rates tried: the whole range in 1 s to 128 s
    int delay_doublings = 6;                ///< delays tried, from half a row on
    std::size_t rows_per_coefficient = 10;  ///< least rows of a fit; by hand
    double least_gain = 0.03;               ///< mean of logarithms; method/physics.md, Alignment
    double gaining_share = 0.6;             ///< of the folds; method/physics.md, Alignment
    double clear = 3.0;                     ///< standard errors of a gain; as above
    double slope_correlation = 0.5;         ///< least, of a velocity's slope to a target; by hand
    double unexplained = 6.0;               ///< root mean squares of the usual fold: an error of a
                                            ///< row that no alignment explains; by hand
    double least_left_out = 0.002;          ///< of the rows: fewer have no say; by hand
    double most_left_out = 0.1;             ///< of the rows: more are another vehicle's; by hand
    std::size_t most_fitted_rows = 5'000;   ///< rows per fit, for the cost; by hand
    double rounding = 1e-6;                 ///< of a target's variance: smaller errors are equal
    double error_cap = 1.5;                 ///< of a target's variance; by hand
    double least_variance = 1e-12;          ///< of a target with a largest value of 1
    double unit_ridge = 1.0;                ///< against sums over rows of unit mean square
    std::size_t kernel_rows = 300;          ///< per fifth of the log, for the cost; by hand
    double kernel_gamma = 0.15;             ///< per standardised distance²; by hand
    double kernel_terms = 0.05;             ///< weight of the terms' kernel; by hand
    double kernel_ridge = 0.01;             ///< of a unit kernel; by hand
  } alignment;

  /// Search of the current (find_current()).
  struct Water {
    std::size_t most_fitted_rows = 3'000;  ///< rows per fit, for the cost; by hand
    std::size_t blocks_per_fold = 5;  ///< spread over the log, since a current wanders; by hand
    double least_between_s = 60.0;    ///< s between two times of a current; by hand
    std::size_t most_knots = 33;      ///< times of a current, for the cost; by hand
    int most_steps = 12;              ///< of a fit; by hand
    int halvings = 5;                 ///< of a step that does not improve; by hand
    double settled = 1e-4;            ///< of the sum of squares: a smaller step ends a fit
    double smooth = 0.01;             ///< weight of a difference between two times, against
                                      ///< the rows between the two; by hand
    double still = 1e-4;              ///< weight of still water, the same; by hand
    double difference_m_s = 1e-3;     ///< m/s, of slopes; by hand
    double turn_s = 2.0;              ///< s of a turn, compared with the yaw rate; by hand
    double least_turn_rad = 0.5;  ///< rad, least root mean square of a turn times √turns that tells
                                  ///< the unit of a heading; by hand
    double unit_tolerance = 0.15;  ///< of the unit of a heading; by hand
    double most_rate = 6.3;        ///< rad/s: a faster yaw rate is in degrees
  } water;

  /// Intervals of lags (lag_intervals in alignment/alignment.hpp).
  struct LagProfile {
    double factor = 1.189207115002721;  ///< between lags tried: four per octave; by hand
    int steps = 12;                     ///< tried on either side: to an eighth and eight times
    double errors = 1.83;  ///< standard errors: 90 % of Student's t with nine degrees of freedom
    double flat = 1e-9;    ///< logarithm: smaller differences of errors are rounding
  } lag_profile;
} kAlignmentTuning;

}  // namespace kelpie
