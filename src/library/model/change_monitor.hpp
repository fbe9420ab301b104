// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kelpie/core/archive.hpp"
#include "kelpie/motion/term_set.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "learner/error_correlation.hpp"
#include "learner/triangular_fit.hpp"
#include "model/change_start.hpp"
#include "model/command_gain.hpp"
#include "model/errors_by_effect.hpp"

namespace kelpie {

/// Detects a change of the vehicle from all axes together, and tells the change of the
/// coefficients.
///
/// The vehicle without a change is a least-squares fit y = Θᵀφ of all rows so far. Every 10 s a
/// start begins: the hypothesis that the vehicle has changed at this moment, and that a change
/// scales the effects that are there. Of a start with the coefficients Θ₀,
///
///     Θ = Θ₀ + Σ_c s_c D_c(Θ₀),    s_c ~ N(0, 0.5²) at first,
///
/// with a cause c per command (all its terms on all axes), per axis for drag (v and v|v|), and per
/// axis for inertia (all terms). Rows update the sizes s_c (Kalman 1960). Most changes have one
/// cause: beside all sizes together, each cause alone is estimated, and so are drag and inertia of
/// all axes; the sizes of a change are the mean of these hypotheses, weighted by their likelihood
/// (Bayesian model averaging: Hoeting, Madigan, Raftery & Volinsky 1999). The evidence of a start
/// is the logarithm of its Bayes factor against the fit (Kass & Raftery 1995), from predictions
/// made before a row is learned, summed over rows and axes. τ rows count as one independent sample
/// (ErrorCorrelation), and no sample counts more than 1.5 nats. A change is believed where the
/// evidence exceeds 40 nats and twice the largest evidence of starts without a change, and 0.45
/// nats per independent sample (0.3 with one likely cause): slow drifts, which a model follows
/// anyway, gain less. The usual error of a row is that of rows with effects of this size
/// (ErrorsByEffect).
///
/// From then on the fit stands still, the start goes on learning for a minute, and the coefficients
/// follow. Another minute later the vehicle with the change is the vehicle without a change.
/// Before, a loss of evidence withdraws the change: a disturbance has passed.
///
/// Rows less than 0.24 s after the row before are skipped. Cost of a row: O(m² a) for m terms and a
/// axes, and O(a (m + q²)) per start for q causes; at most kMostStarts starts live at a time.
/// Allocates in the constructor only.
class ChangeMonitor {
 public:
  /// The outcome of a row.
  enum class Event : std::uint8_t {
    none,
    changed,    ///< a change is believed; since() and step() are set
    refined,    ///< the size of the change has moved by step()
    withdrawn,  ///< the last change was an error; step() leads back
  };

  /// `states`: the input that the target of each axis accelerates. `commands`: the inputs that are
  /// commands, ascending. Requires terms of these inputs.
  ChangeMonitor(const TermSet& terms, std::span<const std::size_t> states,
                std::span<const std::size_t> commands);

  /// Adds the row of the inputs x, a target per axis and the time t [s]. Requires finite values and
  /// times that do not decrease.
  Event update(std::span<const double> x, std::span<const double> y, double t);

  /// Believes at once that a diagnosis has named a thruster, with a factor on its effect as size,
  /// since `since_s` [s]. The change is on probation as any other, and rows go on refining its
  /// size. Ensures: `none` and nothing done for other causes, for a command that is no factor of
  /// its terms, while a change is followed, for a change that was followed before, and while usual
  /// errors are not known.
  Event believe_cause(const Cause& cause, double since_s);

  /// The input of a command whose change was named by a diagnosis and is on probation; else none.
  std::optional<std::size_t> named_command() const {
    return named_ && by_gain() && changed_start_ < kMostStarts
               ? std::optional(gains_[gained_].input)
               : std::nullopt;
  }

  /// The diagnosis has taken named_command() back. Ensures: `none` and nothing done without one.
  Event disbelieve_cause();

  double since() const { return since_s_; }  ///< Start of the last change [s].

  /// Change of an axis' coefficients by the last event, [target unit per unit of the term]; the
  /// last number is of the term 1. There are as many terms as the constructor's, or the first.
  std::span<const double> step(std::size_t axis) const {
    return std::span(step_).subspan(axis * columns(), columns());
  }

  /// Whether the last change is of one command's effect.
  bool by_gain() const { return gained_ < commands_; }

  /// Change of every command's effect by the last event; empty where step() tells the change.
  std::span<const CommandGain> gains() const {
    return by_gain() ? std::span(gains_) : std::span<const CommandGain>{};
  }

  /// Another mechanism has found another vehicle: the monitor knows nothing of that vehicle.
  void restart();
  /// The vehicle sets off: nothing so far is of a vehicle that moves, not even what errors are
  /// usual.
  void begin_again();

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  static constexpr std::size_t kMostStarts = 16;

  std::size_t columns() const { return fit_.terms(); }
  std::size_t axes() const { return fit_.targets(); }
  /// Commands, the drag of every axis, the inertia of every axis; then the causes of many.
  std::size_t causes() const { return commands_ + 2 * axes(); }
  std::size_t all_drag() const { return causes(); }
  std::size_t all_inertia() const { return causes() + 1; }
  std::size_t all_commands() const { return causes() + 2; }
  bool known() const;
  double threshold() const;
  double row_weight() const;
  void predict(std::span<const double> y);
  void learn(std::span<const double> y);
  void begin_start(double t);
  void end_old_starts(double t);
  void end_all_starts();
  void find_effects(std::span<const double> theta, std::size_t axis);
  bool errors_known() const;
  void expect_usual_errors(ChangeStart& start) const;
  ChangeStart& start_before(double since_s);
  std::optional<std::size_t> command_of(const Cause& cause) const;
  void observe(ChangeStart& start, std::span<const double> y, bool against_fit);
  bool has_likely_cause(const ChangeStart& start) const;
  std::optional<std::size_t> clear_command(const ChangeStart& start) const;
  void move_gains(const ChangeStart* start);
  bool is_clear(const ChangeStart& start) const;
  const ChangeStart* most_evident() const;
  ChangeStart& youngest_with(double evidence);
  Event believe(ChangeStart& start, double t);
  Event follow(std::span<const double> y, double t);
  Event withdraw();
  Event settle();
  void move_to(const ChangeStart* start);

  TermSet terms_;
  std::size_t commands_;
  /// A command in a term.
  struct Factor {
    std::size_t command = 0;
    bool higher = false;  ///< in a power above the first
  };
  std::vector<std::vector<Factor>> term_commands_;  ///< commands in each term
  std::vector<std::size_t> term_drag_;              ///< axis that each term damps, or none
  TriangularFit fit_;
  std::vector<ErrorsByEffect> scatter_;
  std::vector<ErrorCorrelation> correlation_;
  std::vector<ChangeStart> starts_;
  std::size_t changed_start_;  ///< number of the start believed; kMostStarts: none
  std::size_t gained_;         ///< command of which the effect has changed; commands_: not so
  bool named_ = false;         ///< the last change, by a diagnosis
  double believed_s_;          ///< the last change, by whichever mechanism [s]
  double moved_s_ = 0.0;       ///< last step [s]
  double since_s_ = 0.0;       ///< [s]
  double row_s_;               ///< time of the last row [s]
  double begun_s_;             ///< time of the last start [s]
  std::uint64_t rows_ = 0;
  std::uint64_t begun_ = 0;          ///< starts so far
  double samples_ = 0.0;             ///< independent samples of the fit
  double usual_ = 0.0;               ///< largest evidence of former starts [nats], fading
  std::vector<double> told_, step_;  ///< change of the coefficients in service; last step
  std::vector<double> all_phi_, phi_, weighted_y_, error_;  ///< of the row
  std::vector<double> effect_;               ///< of the row on each axis: root sum of squares
  std::vector<double> usual_error_;          ///< of such rows on each axis; infinite while unknown
  std::vector<bool> scales_;                 ///< per command: every term is a power of the command
  std::vector<CommandGain> gains_;           ///< last event
  double leverage_ = 0.0;                    ///< φᵀPφ of the row
  CauseEffects effects_;                     ///< scratch
  std::vector<double> mixed_;                ///< scratch: per cause
  std::vector<CommandGain> told_gains_;      ///< in service, since before the change
  std::vector<CommandEffect> usual_effect_;  ///< of each command on all rows learned
};

}  // namespace kelpie
