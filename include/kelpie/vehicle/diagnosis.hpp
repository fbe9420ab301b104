// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/core/archive.hpp"
#include "kelpie/motion/attitude.hpp"

namespace kelpie {

/// A possible cause of a change of the vehicle, with one number as its size.
enum class CauseKind : std::uint8_t {
  thruster,       ///< loss of thrust; size: remaining share of the nominal thrust, 1 = all
  drag,           ///< damping of an axis; size: factor on the damping
  load,           ///< carried or dropped; size: factor on the inertia along the first axis
  force,          ///< constant in the body; size: acceleration of an axis, in the target's unit
  sensor_scale,   ///< scale error of a velocity; size: reading over truth
  sensor_bias,    ///< offset of a velocity; size: in its unit
  frozen,         ///< constant reading of a velocity; size: the reading
  all_thrusters,  ///< all thrusters by one factor (battery, limit); size: share of the thrust
                  ///< before
};

inline constexpr std::size_t kCauseKinds = 8;  ///< number of CauseKind values

/// One cause with its size and a 90 % interval of the size.
struct Cause {
  CauseKind kind = CauseKind::thruster;
  std::size_t place = 0;  ///< input of a thruster or sensor; target of drag or force; else 0
  double size = 0.0;      ///< best estimate
  double lower = 0.0;     ///< lower end of the interval
  double upper = 0.0;     ///< upper end
};

/// State of the explanation of a change.
enum class FindingState : std::uint8_t {
  looking,    ///< a change is certain, its cause is not known yet
  named,      ///< one cause explains the change, or two causes together (`count`)
  ambiguous,  ///< `rival` explains the change nearly as well: more excitation is needed
  none,       ///< no known cause and no pair of causes explains the change
};

inline constexpr std::size_t kFindingStates = 4;  ///< number of FindingState values

/// A change of the vehicle and its explanation.
struct Finding {
  double since_s = 0.0;                        ///< time of the change, to one block of rows
  double found_s = 0.0;                        ///< time of detection
  double told_s = 0.0;                         ///< time of the last change of `state`
  FindingState state = FindingState::looking;  ///< progress of the explanation
  bool settled = false;         ///< the explanation is final; the changed vehicle is the reference
  std::size_t count = 0;        ///< number of causes: 1 or 2; 0 without a name
  std::array<Cause, 2> causes;  ///< the first `count` are valid
  std::array<double, 2> before{1.0, 1.0};  ///< size of a thruster's cause before the change; else 1
  Cause rival;                             ///< the second-best explanation
  double evidence = 0.0;   ///< log likelihood ratio of the explanation against no change
  double margin = 0.0;     ///< log likelihood ratio against `rival`
  double explained = 0.0;  ///< share of the gain of an unrestricted refit, 0 to 1
};

/// Detects changes of a vehicle and names their causes. Fossen's equations of motion are fitted by
/// least squares to all axes at once. When the rows of the last minute contradict earlier rows, the
/// single cause or the pair of causes with the highest likelihood is reported, with sizes.
/// docs/howto/diagnosis.md.
///
///     Diagnosis diagnosis(6, {0, 1, 2}, {0, 1, 5});   // u, v, r and three thrusters
///     diagnosis.update(x, y, t);                      // at every sample, in the log's units
///     for (const Finding& finding : diagnosis.findings()) ...
///
/// Fixed memory; allocates at construction and copy only. Cost: O(terms²) per row, and O(terms³) in
/// some rows of each block.
class Diagnosis {
 public:
  static constexpr std::size_t kUnknownAxis = 6;  ///< for `body_axes`

  /// `states`: the inputs whose derivatives are the targets, in the order of the targets, along or
  /// about `body_axes` (0 to 5: u, v, w, p, q, r; else kUnknownAxis). All other inputs but those of
  /// the attitude and `others`, such as velocities without a target, are thrusters. Requires a
  /// state or more.
  Diagnosis(std::size_t inputs, const std::vector<std::size_t>& states,
            std::vector<std::size_t> body_axes, const Attitude& attitude = {},
            std::span<const std::size_t> others = {});
  Diagnosis(const Diagnosis& other);
  Diagnosis(Diagnosis&& other) noexcept;
  Diagnosis& operator=(const Diagnosis& other);
  Diagnosis& operator=(Diagnosis&& other) noexcept;
  ~Diagnosis();

  /// Number of terms in the equation of each axis.
  static std::size_t terms(std::size_t inputs, std::span<const std::size_t> states,
                           const Attitude& attitude = {});

  /// Processes one sample. Requires as many inputs and targets as at construction. A sample that is
  /// not finite, or has a value above 1e50, is ignored; a clock set back to before the block of
  /// rows begins a new one.
  void update(std::span<const double> x, std::span<const double> y, double t);

  /// Discards the reference: earlier rows say nothing of the vehicle, as at rest. Findings stay; a
  /// change under inspection is inspected to its end, and nothing is discarded.
  void restart();

  /// The last kMostFindings changes, the oldest first.
  const std::vector<Finding>& findings() const;
  std::size_t found() const;                        ///< Number of changes since the start.
  static constexpr std::size_t kMostFindings = 64;  ///< of findings()

  /// Thrust of every thruster in the last minute over the thrust in the reference; 1: unchanged.
  /// Empty before ready(). The interval of an idle thruster is infinite, and of every thruster
  /// after the first 24 less the number of axes.
  const std::vector<Cause>& health() const;

  bool ready() const;  ///< Whether there are enough rows for a reference.

  bool knows_thrust() const;  ///< Whether there was a reference once: for the next two functions.
  /// What a thruster (an input) at a command does to all axes, at rest: of the `nominal` vehicle,
  /// before thrust first changed, or now, times present(). Requires acceleration and half_width (of
  /// 90 % intervals; may be empty) with a value per axis. Allocates.
  void thrust(std::size_t input, double command, bool nominal, std::span<double> acceleration,
              std::span<double> half_width = {}) const;
  /// Accelerations at the inputs x of the vehicle now, less those at rest.
  void accelerations(std::span<const double> x, std::span<double> acceleration) const;
  std::size_t inputs() const;                      ///< Number of inputs.
  std::span<const std::size_t> states() const;     ///< The velocities, in the order of the axes.
  std::span<const std::size_t> body_axes() const;  ///< As constructed.
  /// Share of the nominal thrust of every thruster, by the named changes of this thruster alone: a
  /// change without a name counts for none.
  const std::vector<Cause>& present() const;

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// Names of the columns of a Diagnosis, in their order.
struct DiagnosisNames {
  std::span<const std::string> inputs;   ///< columns of x
  std::span<const std::string> targets;  ///< columns of y
};

std::string_view kind_name(CauseKind kind);       ///< "thruster", "sensor_scale", …
std::string_view state_name(FindingState state);  ///< "named", "ambiguous", …

/// The column of a cause: the input of a thruster or sensor, the target of a drag or force; empty
/// for a load and all thrusters.
std::string cause_column(const Cause& cause, const DiagnosisNames& names);

/// "th2 gives 48 % of its thrust (41 to 55 %)".
std::string cause_text(const Cause& cause, const DiagnosisNames& names);

/// Commands in use of a thruster.
struct CommandRange {
  std::size_t input = 0;
  double least = 0.0;  ///< full astern; 0 is at rest
  double most = 0.0;   ///< full ahead
};

/// What a thruster does to all axes at full ahead and full astern, at rest: a column of the
/// effectiveness matrix on either side.
struct ThrusterEffect {
  CommandRange range;
  std::vector<double> ahead, astern;              ///< accelerations per axis, now
  std::vector<double> ahead_width, astern_width;  ///< half widths of 90 % intervals
  std::vector<double> nominal_ahead, nominal_astern;
  double share = 1.0;  ///< of the nominal thrust, 0: dead
};

/// The greatest accelerations of an axis at rest, in either direction.
struct AxisAuthority {
  double most = 0.0;  ///< whatever the other axes do
  double least = 0.0;
  double nominal_most = 0.0;
  double nominal_least = 0.0;
  double alone_most = 0.0;  ///< while the other axes are held at 0
  double alone_least = 0.0;

  double left() const;  ///< Share of the nominal range; 1: all.
};

/// Commands for wanted accelerations.
struct Allocation {
  std::vector<double> commands;  ///< per thruster, in the order of the ranges
  std::vector<double> reached;   ///< accelerations per axis
  double missing = 0.0;          ///< largest part that isn't reached, of the nominal range
};

/// What the thrusters of a vehicle can still do: from the coefficients that a Diagnosis has learned
/// (its present state is copied) to the effectiveness matrix B, its singular values, the attainable
/// accelerations (Durham 1993) and commands for wanted accelerations: with shares z of full ahead
/// and full astern,
///
///     min |S⁻¹ (τ − B z)|² + ρ |z|²,   0 ≤ z ≤ 1,
///
/// S the nominal range of each axis, ρ = 1e-6, by a primal active set (Nocedal & Wright 2006,
/// algorithm 16.3; for control allocation Härkegård 2002). A thruster goes ahead or astern, not
/// both. Thrust is that at rest: inflow isn't in it.
class Authority {
 public:
  /// Throws InputError (diagnosis) before the diagnosis is ready, and (ranges) on none, an input
  /// that is no thruster or named twice, a number that isn't finite, and a range without 0.
  /// Allocates.
  Authority(const Diagnosis& diagnosis, const std::vector<CommandRange>& ranges);

  const std::vector<ThrusterEffect>& thrusters() const { return thrusters_; }
  const std::vector<AxisAuthority>& axes() const { return axes_; }
  /// Singular values of S⁻¹ B, greatest first, one per axis; and before any change.
  const std::vector<double>& singular_values() const { return singular_; }
  const std::vector<double>& nominal_singular_values() const { return nominal_singular_; }
  /// The axis of the least singular value, where it is below a tenth of its nominal value: hardly
  /// under control. Else axes().size().
  std::size_t lost_axis() const { return lost_; }

  /// Commands for accelerations, at rest. Throws InputError (wanted) on another size and numbers
  /// that aren't finite. Allocates. Cost: O(thrusters³) per change of the active set.
  Allocation allocate(std::span<const double> wanted) const;

  /// The fastest water from ahead [velocity of the log] in which the vehicle holds its place, at
  /// most 5; NaN where no axis is surge. Speeds beyond those driven are an extrapolation.
  double held_current() const { return held_current_; }

  /// "th2 gives 60 % of its thrust: surge 0.80, yaw 0.50 of nominal left; holds a current of 0.30
  /// m/s from ahead", in the log's unit of surge, `speed_unit`; behind "NEARLY NO AUTHORITY left in
  /// yaw; " where lost_axis() is one. Names in the order of the diagnosis; an unknown axis is
  /// called by its target.
  std::string text(const DiagnosisNames& names, std::string_view speed_unit = {}) const;

 private:
  double attainable(std::size_t axis, double sign, bool nominal) const;
  double attainable_alone(std::size_t axis, double sign) const;
  void find_singular_values();
  void find_held_current(const Diagnosis& diagnosis);
  std::vector<double> shares_for(std::span<const double> wanted) const;
  double command_for(std::size_t thruster, double share) const;

  std::vector<std::size_t> body_axes_;
  std::vector<ThrusterEffect> thrusters_;
  std::vector<std::array<double, 2>> half_;  ///< share of full thrust at half the command, by side
  std::vector<AxisAuthority> axes_;
  std::vector<double> scale_;  ///< S
  std::vector<double> singular_, nominal_singular_;
  std::size_t lost_ = 0;
  double held_current_ = 0.0;
};

/// The text of a finding: its causes joined by "and", a thruster that had changed before with its
/// share before, "th2 gives 100 % of its nominal thrust again (99 to 101 %; before 0 %)"; for an
/// ambiguous change both candidates and the manoeuvres that separate them; or the statement that no
/// known cause explains the change.
std::string finding_text(const Finding& finding, const DiagnosisNames& names);

}  // namespace kelpie
