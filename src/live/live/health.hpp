// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "kelpie/alignment/alignment.hpp"
#include "kelpie/stream/signal_history.hpp"
#include "kelpie/svr/regressor.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "live/transport.hpp"

namespace kelpie::live {

/// State of a topic that the configuration names.
struct TopicHealth {
  std::string name;
  std::string refused{};        ///< why its messages cannot be used; empty: usable, or none yet
  std::size_t messages = 0;     ///< received
  std::size_t undecodable = 0;  ///< received messages of another type
  std::string last_error{};     ///< of the last undecodable message
};

/// State of a signal.
struct SourceHealth {
  std::string name;
  std::string from;       ///< topic and field
  double rate_hz = 0.0;   ///< since the previous health
  double silent_s = 0.0;  ///< by the newest stamp of all signals; infinite: no sample yet
  double gap_s = 1.0;     ///< `gap` of [log]: a longer silence is an alert
  bool is_stuck = false;  ///< the value has been constant for longer than `gap_s`
  SignalFaults faults{};  ///< since the start

  bool is_silent() const { return silent_s > gap_s; }
};

/// State of an axis. Scores cover the last `judged` samples; simple predictors
/// (study/baselines.hpp) start anew with the program. NaN: not known yet.
struct AxisHealth {
  std::string name;
  Status status;
  std::size_t judged = 0;
  double r2 = std::numeric_limits<double>::quiet_NaN();  ///< one step ahead
  double r2_least_squares = r2;
  double r2_mean = r2;
  double r2_last_value = r2;
  double coverage = r2;      ///< share of samples inside the interval
  double disturbance = 0.0;  ///< at the last sample
  double authority = r2;     ///< share of the nominal range of accelerations that is left
  std::vector<Coefficient> coefficients{};
};

/// Share of its thrust at the start that a thruster gives, with an interval
/// (study::since_the_start()).
struct ThrusterHealth {
  std::string name;
  double share = 1.0;
  double lower = 1.0;
  double upper = 1.0;
};

/// A parameter of the vehicle in the plane, as `kelpie identify` names it.
struct ParameterHealth {
  std::string name;
  double value = std::numeric_limits<double>::quiet_NaN();  ///< NaN: not told so far
  double interval = value;  ///< half width of the 90 % interval over the size of the parameter
};

/// Estimate of a velocity, measured or reckoned.
struct VelocityHealth {
  std::string name;
  double value = std::numeric_limits<double>::quiet_NaN();  ///< NaN: no estimate
  double deviation = value;                                 ///< standard deviation
};

/// State of dead reckoning: velocities through outages of the velocity log.
struct ReckoningHealth {
  std::vector<VelocityHealth> velocities{};
  double silent_s = 0.0;    ///< since the velocity log measured a velocity
  std::string fault{};      ///< why the velocity log isn't used at present; empty: in use
  std::size_t outages = 0;  ///< outages that have ended
  double longest_s = 0.0;   ///< the longest of these
  /// Of the water over ground, in the plane [m/s]; 0: none was found. NaN: not known.
  double current_speed = std::numeric_limits<double>::quiet_NaN();
  double current_direction = current_speed;  ///< where it goes, as a reading of the heading [°]
  double largest_step = 0.0;  ///< of a velocity at a measurement, in standard deviations before
};

/// What the thrusters can do, in units of the effects that `alignment` makes of commands.
struct Effectiveness {
  Authority authority;
  Alignment alignment;
};

/// State of the learner. `is_paused` is the operator's doing (request `freeze`); a `stuck` velocity
/// is a fault of the vehicle.
struct LearnerHealth {
  std::size_t rows = 0;         ///< complete rows received
  std::size_t learned = 0;      ///< samples shown to the model, of earlier starts too
  std::size_t rows_stuck = 0;   ///< rows not learned: a velocity was stuck
  bool is_paused = false;       ///< learning is paused by request
  std::size_t rows_paused = 0;  ///< rows not learned: learning was paused
  Alignment alignment{};
  std::vector<AxisHealth> axes{};
  std::string vehicle{};  ///< the last finding about the vehicle, in words; empty: none
  std::string doubt{};    ///< why the model is doubtful (RowCheck), in words; empty: no reason
  std::vector<ThrusterHealth> thrusters{};
  std::vector<ParameterHealth> parameters{};  ///< that are to be told
  std::size_t parameters_known = 0;           ///< of these, as well as was asked
  std::string countdown{};  ///< how many of these are known, and which is known least; empty: none
  std::string authority{};  ///< what is left of it, in words; empty: all, or unknown
  double held_current = std::numeric_limits<double>::quiet_NaN();  ///< Authority::held_current()
  std::shared_ptr<const Effectiveness> effectiveness{};            ///< null: unknown
  double last_t_s = 0.0;                                           ///< of the last row
  double checkpoint_t_s = 0.0;  ///< of the last row in the newest checkpoint
  std::size_t checkpoints = 0;
  std::size_t checkpoints_failed = 0;
  std::string checkpoint_error{};  ///< of the last checkpoint; empty: written
  double median_delay_ms = 0.0;  ///< from the message that completes a row until the row is learned
  double longest_delay_ms = 0.0;  ///< both over the last rows
};

/// State of a live run at one moment. live/health_table.hpp describes every number.
struct Health {
  std::int64_t stamp_ns = 0;  ///< when the newest message was received
  double idle_s = 0.0;        ///< since the last message, by this machine's clock
  TransportHealth transport;
  std::vector<TopicHealth> topics;
  std::vector<SourceHealth> sources;
  std::size_t clock_restarts = 0;   ///< times a clock was set back
  std::size_t rows = 0;             ///< made of messages
  std::size_t rows_incomplete = 0;  ///< rows with a value missing
  std::string no_rows{};            ///< why there is no whole row; empty: there are
  double row_late_s = 0.0;       ///< from the last row's time to the message that completed the row
  std::size_t rows_dropped = 0;  ///< lost: the queue to the learner was full
  std::size_t rows_waiting = 0;  ///< in the queue
  std::string record_error{};    ///< why nothing is recorded; empty: no error
  std::size_t unrecorded = 0;    ///< messages that aren't in a recording
  ReckoningHealth reckoning;
  LearnerHealth learner;
};

}  // namespace kelpie::live
