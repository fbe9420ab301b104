// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/roomy_vector.hpp"
#include "kelpie/core/archive.hpp"
#include "vehicle/comparison.hpp"

namespace kelpie {

/// Detects a change of the coefficients of the equations of motion. The last minute of rows is kept
/// in blocks; earlier rows form the reference, which forgets within an hour. Every new block is
/// compared with the reference in windows of 2 to 24 blocks. An alarm is raised when the evidence
/// of one explanation exceeds chance and the usual evidence in this window without a change.
/// Allocates at construction only.
class CoefficientMonitor {
 public:
  static constexpr std::size_t kBlocks = 24;  ///< number of blocks outside the reference

  /// Arguments as for Diagnosis.
  CoefficientMonitor(std::size_t inputs, std::span<const std::size_t> states,
                     std::vector<std::size_t> body_axes, const Attitude& attitude,
                     std::span<const std::size_t> others);

  const MotionTerms& terms() const { return terms_; }
  const Explanations& explanations() const { return explanations_; }
  const ReferenceFit& fit() const { return fit_; }  ///< of the reference at the last block
  std::span<const double> directions() const { return directions_; }  ///< of all explanations
  Comparison& comparison() { return comparison_; }                    ///< the last comparison

  bool ready() const;  ///< Whether the reference has enough rows.

  void restart();  ///< Discards all rows, and what is usual.

  /// Stores the newest block, with its first and last rows at these times [s], and starts over with
  /// the shortest window. A change in this block is told since `since_s`. Requires two rows or
  /// more, and start_s < end_s.
  void insert(const NormalEquations& block, double start_s, double end_s, double since_s);
  /// Tests one window, the shortest first. Returns true when all windows are tested and an alarm is
  /// raised; the next call has to be cut() or insert(). Cost: O(terms³).
  bool step();
  /// Place of a change among the blocks.
  struct Cut {
    double since_s;      ///< time of the first row after the change
    std::size_t blocks;  ///< number of blocks after the change, guard included
  };
  /// After an alarm: finds the cut with the most evidence. Earlier blocks join the reference; later
  /// blocks, without the first `guard`, are added to `after`. No block is left.
  Cut cut(std::size_t guard, NormalEquations& after);
  void drop_since(double t);  ///< Drops the blocks with rows later than t.

  void compare(const NormalEquations& stretch);  ///< With the reference, into comparison().
  /// Scatter of a minute of the unchanged vehicle over the scatter of independent noise; >= 1.
  double usual_scatter() const;

  const NormalEquations& reference() const { return reference_; }
  std::size_t watched() const { return watched_; }  ///< Number of fits to the reference so far.

  /// Makes the changed vehicle the reference: coefficients plus `delta` (empty: unknown), the
  /// weight of the reference times `kept`, and `rows` of the changed vehicle.
  void accept_change(std::span<const double> delta, double kept, const NormalEquations& rows);

  /// Coefficients (terms × axes) in place of those of the reference, where not 0, for the
  /// directions of thrusters: a dead thruster has no direction in the reference. Allocates nothing.
  void expect_thrust(std::span<const double> thrust);

  const std::vector<Cause>& health() const { return health_; }  ///< Diagnosis::health()

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  void absorb_oldest();
  void add_newest(std::size_t from, std::size_t to);
  void test_window(std::size_t window);
  void update_health();
  void find_directions();
  std::size_t sharpest_cut();

  MotionTerms terms_;
  Explanations explanations_;
  ReferenceFit fit_;
  Comparison comparison_;
  NormalEquations reference_, window_sums_;
  std::vector<NormalEquations> blocks_;  // the oldest at first_
  std::vector<double> starts_;           // since when a change in them is told
  std::size_t first_ = 0, kept_ = 0;
  double rate_hz_ = 0.0;       // the highest of a block's rows, fading
  std::size_t window_;         // next to be tested
  std::size_t alarm_ = 0;      // window with the largest excess, from 1; 0: no alarm
  double alarm_excess_ = 0.0;  // evidence of this window above its threshold
  std::size_t watched_ = 0;    // number of tested blocks
  std::vector<double> usual_;  // windows × (explanations + refit): scatter without a change
  std::vector<double> expected_thrust_, thrust_;  // of expect_thrust(); of the directions
  std::vector<double> directions_;
  std::vector<std::size_t> health_columns_;
  RoomyVector<Cause> health_;
};

}  // namespace kelpie
