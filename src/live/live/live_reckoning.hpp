// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kelpie/alignment/alignment.hpp"
#include "kelpie/navigation/dead_reckoning.hpp"
#include "live/configuration.hpp"
#include "live/heading_reader.hpp"
#include "live/health.hpp"
#include "live/output.hpp"
#include "live/present_commands.hpp"
#include "live/receiver.hpp"

namespace kelpie::live {

/// A model for dead reckoning, as of a row.
struct ReckoningModel {
  OpenLoop loop;
  std::shared_ptr<const Alignment> alignment;  ///< of the model's commands
};

/// The equations of motion of a model; null before there are any.
std::shared_ptr<const ReckoningModel> reckoning_model(const DynamicsModel& model,
                                                      std::shared_ptr<const Alignment> alignment);

/// Velocities at every message, through outages of the velocity log: a DeadReckoning between the
/// receiver and the learner (docs/method/open_loop.md#live). Velocities from poses are known half a
/// window late: a DeadReckoning takes the rows, and a copy goes on from the newest row to the
/// newest message. Where commands fall silent the last ones are held, with the error of a model
/// that knows no commands: measurements alone tell the velocities then, and without any there is no
/// estimate. Models come from the learner as of certain rows and serve a fixed time later, so
/// that a replay gives the numbers of the live run. For the receiving thread.
class LiveReckoning {
 public:
  explicit LiveReckoning(const Configuration& configuration);

  /// Whether the model before the whole row at `t` [s] is wanted from the learner.
  bool wants_model(double t);

  /// Whether the wanted model has to serve at the time `now_s` [s].
  bool is_due(double now_s) const { return waits_ && now_s >= due_s_; }

  /// Serves with the wanted model; null: there is none yet. Allocates.
  void use(std::shared_ptr<const ReckoningModel> model);

  /// Takes the newest message in. The new estimate, valid until the next call; empty without one.
  /// Begins and ends of outages are events of `output`.
  std::optional<ReckonedSample> update(const Receiver& receiver, std::int64_t received_ns,
                                       Output& output);

  /// Takes a row of `receiver` as a measurement, where velocities come from poses. Allocates.
  void take_row(const SampleRow& row, const Receiver& receiver, Output& output);

  /// Places of the inputs that poses give too late for the present; empty without poses.
  std::span<const std::size_t> late_inputs() const { return late_; }
  /// Fills the late inputs with present values. False where there are none yet.
  bool fill_late_inputs(std::span<double> x) const;

  /// Whether the row at `t` [s] uses velocities that the velocity log didn't measure: exact zeros
  /// or frozen values. Valid after the row was made.
  bool is_invalid(double t) const;

  ReckoningHealth health() const;

 private:
  CommandPath path() const;
  void take_sample(double t, const Receiver& receiver, Output& output);
  bool take_velocities(const Receiver& receiver);
  std::optional<ReckonedSample> sample(const Receiver& receiver, std::int64_t received_ns,
                                       Output& output);
  std::optional<ReckonedSample> update_present(const Receiver& receiver, std::int64_t received_ns,
                                               Output& output);
  void advance(const Receiver& receiver, double t);
  double usual_silence_s() const;
  void follow_commands(bool has_commands);
  void note_loss(Output& output);
  const DeadReckoning* present() const { return late_.empty() ? reckoning_.get() : present_.get(); }
  void begin_anew(const Receiver& receiver);
  void note_faults();
  void note_outage(Output& output);

  const Configuration& configuration_;
  std::vector<std::size_t> states_;  // places of the velocities; empty: unknown, or too many
  std::vector<std::string> names_;
  DeadReckoningSettings settings_;
  std::vector<std::size_t> heard_;  // samples of each velocity, so far
  PresentCommands commands_;
  std::shared_ptr<const ReckoningModel> model_;
  std::shared_ptr<const Alignment> aligned_;  // of the commands that reckoning_ has
  std::unique_ptr<DeadReckoning> reckoning_;
  HeadingReader heading_;
  std::vector<std::size_t> late_;
  std::vector<double> row_x_;               // the last row's
  std::unique_ptr<DeadReckoning> present_;  // goes on from a row; null without poses
  PresentCommands present_commands_;        // of present_
  double based_s_ = -std::numeric_limits<double>::infinity();  // row that present_ goes on from
  std::vector<double> x_;
  double t_ = -std::numeric_limits<double>::infinity();  // of the last estimate
  double asked_s_ = t_;                                  // row of the last wanted model
  double due_s_ = 0.0;
  bool waits_ = false;  // for a wanted model
  std::size_t restarts_ = 0;
  VelocityFault fault_ = VelocityFault::none;  // of the velocity log
  double believed_s_ = t_;                     // the last plausible velocities of the log
  double invalid_from_s_ = std::numeric_limits<double>::infinity();
  double invalid_until_s_ = -std::numeric_limits<double>::infinity();
  bool is_out_ = false;     // an outage was reported
  double measured_s_ = t_;  // the last measurement
  bool holds_ = false;      // an input is silent
  double held_from_s_ = 0.0;
  bool is_lost_ = false;  // an input is silent and no velocity is measured
  ReckoningHealth health_;
};

}  // namespace kelpie::live
