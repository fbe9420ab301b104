// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>

namespace kelpie::live {

/// Behavioural constants of the live run. Where no page of docs/ is named, the value was chosen by
/// hand and no measurement is recorded.
inline constexpr struct Tuning {
  // Messages
  std::chrono::milliseconds longest_wait{50};  ///< for a message, between two checks for a stop
  std::size_t most_held = 10'000;  ///< samples before there is an origin; bounds a flood
  double longest_idle_s = 2.0;     ///< without any message, until an error is reported
  std::size_t history = 4096;      ///< samples per signal: 2 s at 2 kHz; windows, gap and lags fit
  double pose_rate_hz = 500.0;     ///< of signals beside a pose, whose whole window is kept
  std::size_t most_history = 100'000;          ///< samples per signal: 1.6 MB
  std::chrono::seconds between_recordings{5};  ///< [s] between two chunks of a recording; the index
                                               ///< in memory grows with each; docs/howto/live.md

  // Rows
  std::size_t queued_rows = 4096;  ///< rows that may wait for the learner; docs/howto/live.md
  std::chrono::milliseconds between_requests{500};  ///< a checkpoint each; equal ones join
                                                    ///< meanwhile; docs/howto/live.md
  std::chrono::seconds longest_farewell{5};  ///< for the rows that wait at the end; systemd kills
                                             ///< after 90 s, an operator's patience is shorter
  std::chrono::seconds longest_row{60};  ///< [s] for one row, with an alignment search in it, until
                                         ///< the watchdog sees a hang; docs/howto/live.md
  double command_steps_per_row = 4.0;    ///< at most, of an actuator: messages come far more often
                                         ///< than rows, and a delay keeps few commands
  double most_kept_rows = 1e6;           ///< of a recording, for the alignment: a day at 10 Hz

  double longest_in_vain_s = 10.0;  ///< of rows with a value missing, until that is told

  // Plausibility
  double checked_s = 120.0;              ///< of rows in a check: 24 windows of 5 s; howto/live.md
  double checked_rate_hz = 50.0;         ///< rows beyond tell a check no more
  std::size_t least_checked_rows = 121;  ///< at low rates: 24 windows of 5 rows

  // Dead reckoning (docs/method/open_loop.md#live)
  double between_models_s = 10.0;       ///< by the rows' clock
  double between_first_models_s = 2.0;  ///< until there is a model
  double model_delay_s = 2.0;    ///< from a row until the model before that row serves: so live and
                                 ///< replayed runs change models at the same messages
  double least_step_s = 0.02;    ///< between two estimates without a measurement
  double between_poses_s = 0.1;  ///< between two rows of a pose from which the present is reckoned
  double least_outage_s = 1.0;   ///< s of silence; shorter silences are usual
  double longest_hold_s = 10.0;  ///< of silent commands, until practice is of another model

  // Heading
  double heading_deviation_rad = 0.03;  ///< of a reading: 2°, a compass aboard
  double heading_turn_rad = 1.0;        ///< of the vehicle, which tells the sense of the readings
  double heading_ratio = 2.0;           ///< between the turns of readings and vehicle, at most
  double longest_heading_silence_s = 60.0;  ///< until the current has no direction: a gyro drifts

  // Parameters (docs/howto/live.md#parameters)
  double identified_s = 1800.0;            ///< of rows that are identified: 3600 windows
  double forgotten_s = 300.0;              ///< of rows that go at a time, the oldest
  double between_identifications_s = 5.0;  ///< a fit of half an hour takes 0.3 s at 20 Hz
  double told_by_s = 60.0;                 ///< of driving, which tells how long the rest takes
  double longest_forecast_s = 3600.0;      ///< beyond, the way of driving tells too little

  // Reports
  double authority_news = 0.05;  ///< of the nominal range; docs/howto/diagnosis.md
  double least_pause_s = 0.1;    ///< between checkpoints or reports of status; reference/limits.md
  double longest_pause_s = 1e6;  ///< 12 days
  std::size_t most_events = 10;  ///< of a kind in a minute; docs/howto/live.md
  std::size_t most_event_kinds = 1000;      ///< beyond, all others are one kind
  std::chrono::seconds between_reports{1};  ///< [s] between two healths
  std::size_t scored_samples = 600;         ///< for R² and coverage: a minute at 10 Hz
  std::size_t timed_rows = 1000;            ///< for the median and the longest delay
} kTuning;

}  // namespace kelpie::live
