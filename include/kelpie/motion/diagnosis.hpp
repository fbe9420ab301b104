// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/core/archive.hpp"
#include "kelpie/motion/judgement.hpp"
#include "kelpie/motion/standstill.hpp"
#include "kelpie/motion/watch.hpp"

namespace kelpie {

/// What has become of a vehicle, by name: watches the equations of motion in Fossen's structure,
/// fitted by least squares to all axes at once, and when the last minute's rows no longer agree
/// with those before says which single cause, or which two, explain the difference, with sizes.
/// docs/diagnosis.md.
///
///     Diagnosis diagnosis(6, {0, 1, 2}, {0, 1, 5});   // u, v, r and three thrusters
///     diagnosis.update(x, y, t);                      // at every sample, in the log's units
///     for (const Finding& finding : diagnosis.findings()) ...
///
/// Fixed memory; allocates at construction only. Cost: O(terms²) per row, and O(terms³) in some
/// rows of each block of ten.
class Diagnosis {
 public:
  static constexpr std::size_t kUnknownAxis = 6;  ///< of the body

  /// Of so many inputs, of which `states` are the velocities that the targets accelerate, in their
  /// order, along or about `body_axes` (0 to 5: u, v, w, p, q, r; else kUnknownAxis). All
  /// other inputs count as thrusters. Requires a state or more.
  Diagnosis(std::size_t inputs, std::vector<std::size_t> states,
            std::vector<std::size_t> body_axes);

  /// Looks at one sample. Requires as many inputs and targets as at construction. A sample that
  /// isn't finite is passed over.
  void update(std::span<const double> x, std::span<const double> y, double t);

  /// All changes found, the oldest first; no more than the last kMostFindings.
  const std::vector<Finding>& findings() const { return findings_; }
  std::size_t found() const { return found_; }      ///< How many there have been since the start.
  static constexpr std::size_t kMostFindings = 64;  ///< of findings()

  /// The effectiveness of every thruster in the last minute against the reference, 1: as before;
  /// none before there is one. The interval is infinite of a thruster that didn't run.
  const std::vector<Cause>& health() const { return watch_.health(); }

  bool ready() const { return watch_.ready(); }  ///< Whether there is a reference to compare with.

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  bool moves(std::span<const double> x, double t);
  bool is_outlier(std::span<const double> y);
  void close_block(double t);
  void open(double t);
  void look(double t);
  void tell(Finding& finding, const Judgement& judgement, double t) const;
  Agreement alone(std::size_t explanation);
  void settle(const Judgement& judgement);
  void know(const Choice& choice);
  void freeze(double t);
  Finding& add_finding(double since, double t);

  Watch watch_;
  Standstill standstill_;
  Sums block_;
  Sums after_;  // rows since the change that is being looked into
  double block_start_ = 0.0;
  bool looking_ = false;    // into the last finding
  std::size_t guard_ = 0;   // blocks still to be passed over
  std::size_t looked_ = 0;  // blocks in after_
  bool outlier_before_ = false;
  std::vector<double> phi_, residual_, delta_, tangent_;
  std::vector<Agreement> alone_;  // of every explanation
  std::vector<Finding> findings_;
  std::size_t found_ = 0;
};

}  // namespace kelpie
