// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "kelpie/model/alignment.hpp"
#include "kelpie/motion/cause.hpp"
#include "kelpie/online/regressor.hpp"
#include "kelpie/stream/signal_history.hpp"
#include "live/receiver.hpp"
#include "live/transport.hpp"

namespace kelpie::live {

/// What is known of a signal.
struct SourceHealth {
  std::string name;
  std::string from;
  double rate_hz = 0.0;   ///< over the time since the health before
  double silent_s = 0.0;  ///< by the newest stamp of all; infinite: it never spoke
  bool is_stuck = false;  ///< its value doesn't change any more
  SignalFaults faults{};  ///< since the start
};

/// What is known of an axis.
struct AxisHealth {
  std::string name;
  Status status;
  std::size_t judged = 0;  ///< samples that what follows is of: the last ones
  double r2 = std::numeric_limits<double>::quiet_NaN();  ///< one step ahead
  double r2_least_squares = r2;                          ///< … of simple predictors, that began
  double r2_mean = r2;                                   ///< with this start of the program
  double r2_last_value = r2;                             ///< (study/baselines.hpp)
  double coverage = std::numeric_limits<double>::quiet_NaN();  ///< of the intervals, likewise
  double disturbance = 0.0;                                    ///< at the last sample
  std::vector<Coefficient> coefficients{};
};

/// What the learner says of itself.
struct LearnerHealth {
  std::size_t rows = 0;     ///< whole ones that came
  std::size_t learned = 0;  ///< samples shown to the model, before this start as well
  std::size_t frozen = 0;   ///< rows passed over: a velocity in them was frozen
  bool is_paused = false;   ///< nothing is learned, as somebody asked
  std::size_t paused = 0;   ///< rows passed over for that
  Alignment alignment{};
  std::vector<AxisHealth> axes{};
  std::string vehicle{};           ///< what became of it last, in words; empty: nothing
  std::vector<Cause> thrusters{};  ///< DynamicsModel::diagnosis(): health
  double last_t_s = 0.0;           ///< of the last row
  double checkpoint_t_s = 0.0;     ///< up to which row the last checkpoint on the disk goes
  std::size_t checkpoints = 0;
  std::size_t checkpoints_failed = 0;
  std::string checkpoint_error{};  ///< of the last one; empty: it was written
  double median_delay_ms = 0.0;    ///< from the message that completes a row to its being learned
  double longest_delay_ms = 0.0;   ///< both of the last rows
};

/// All of it, at one moment.
struct Health {
  double idle_s = 0.0;  ///< for how long no message has come, by our clock
  TransportHealth transport;
  std::vector<TopicHealth> topics;
  std::vector<SourceHealth> sources;
  std::size_t clock_restarts = 0;   ///< a clock was set
  std::size_t rows = 0;             ///< made of messages
  std::size_t rows_incomplete = 0;  ///< of these, with a value missing
  std::size_t rows_dropped = 0;     ///< lost, since the learner was behind by too many
  std::size_t rows_waiting = 0;     ///< for the learner
  std::string record_error{};       ///< why nothing is recorded any more
  LearnerHealth learner;
};

}  // namespace kelpie::live
