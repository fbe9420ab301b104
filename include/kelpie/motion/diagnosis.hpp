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
  thruster,      ///< loss of thrust; size: remaining share of the thrust, 1 = unchanged
  drag,          ///< damping of an axis; size: factor on the damping
  load,          ///< carried or dropped; size: factor on the inertia along the first axis
  force,         ///< constant in the body; size: acceleration of an axis, in the target's unit
  sensor_scale,  ///< scale error of a velocity; size: reading over truth
  sensor_bias,   ///< offset of a velocity; size: in its unit
  frozen,        ///< constant reading of a velocity; size: the reading
};

inline constexpr std::size_t kCauseKinds = 7;  ///< number of CauseKind values

/// One cause with its size and a 90 % interval of the size.
struct Cause {
  CauseKind kind = CauseKind::thruster;
  std::size_t place = 0;  ///< input of a thruster or sensor; target of drag or force; load: 0
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
  Cause rival;                  ///< the second-best explanation
  double evidence = 0.0;        ///< log likelihood ratio of the explanation against no change
  double margin = 0.0;          ///< log likelihood ratio against `rival`
  double explained = 0.0;       ///< share of the gain of an unrestricted refit, 0 to 1
};

/// Detects changes of a vehicle and names their causes. Fossen's equations of motion are fitted by
/// least squares to all axes at once. When the rows of the last minute contradict earlier rows, the
/// single cause or the pair of causes with the highest likelihood is reported, with sizes.
/// docs/diagnosis.md.
///
///     Diagnosis diagnosis(6, {0, 1, 2}, {0, 1, 5});   // u, v, r and three thrusters
///     diagnosis.update(x, y, t);                      // at every sample, in the log's units
///     for (const Finding& finding : diagnosis.findings()) ...
///
/// Fixed memory; allocates at construction and copy only. Cost: O(terms²) per row, and O(terms³) in
/// some rows of each block of ten.
class Diagnosis {
 public:
  static constexpr std::size_t kUnknownAxis = 6;  ///< for `body_axes`

  /// `states`: the inputs whose derivatives are the targets, in the order of the targets, along or
  /// about `body_axes` (0 to 5: u, v, w, p, q, r; else kUnknownAxis). All other inputs but those of
  /// the attitude are thrusters. Requires a state or more.
  Diagnosis(std::size_t inputs, const std::vector<std::size_t>& states,
            std::vector<std::size_t> body_axes, const Attitude& attitude = {});
  Diagnosis(const Diagnosis& other);
  Diagnosis(Diagnosis&& other) noexcept;
  Diagnosis& operator=(const Diagnosis& other);
  Diagnosis& operator=(Diagnosis&& other) noexcept;
  ~Diagnosis();

  /// Number of terms in the equation of each axis.
  static std::size_t terms(std::size_t inputs, std::span<const std::size_t> states,
                           const Attitude& attitude = {});

  /// Processes one sample. Requires as many inputs and targets as at construction. A sample that is
  /// not finite is ignored.
  void update(std::span<const double> x, std::span<const double> y, double t);

  /// The last kMostFindings changes, the oldest first.
  const std::vector<Finding>& findings() const;
  std::size_t found() const;                        ///< Number of changes since the start.
  static constexpr std::size_t kMostFindings = 64;  ///< of findings()

  /// Thrust of every thruster in the last minute over the thrust in the reference; 1: unchanged.
  /// Empty before ready(). The interval of an idle thruster is infinite.
  const std::vector<Cause>& health() const;

  bool ready() const;  ///< Whether there are enough rows for a reference.

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
/// for a load.
std::string cause_column(const Cause& cause, const DiagnosisNames& names);

/// "th2 gives 48 % of its thrust (41 to 55 %)".
std::string cause_text(const Cause& cause, const DiagnosisNames& names);

/// The text of a finding: its causes joined by "and"; for an ambiguous change both candidates and
/// the manoeuvres that separate them; or the statement that no known cause explains the change.
std::string finding_text(const Finding& finding, const DiagnosisNames& names);

}  // namespace kelpie
