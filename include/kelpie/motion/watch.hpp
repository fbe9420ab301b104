// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/core/archive.hpp"
#include "kelpie/motion/comparison.hpp"

namespace kelpie {

/// The vehicle as it has been, in sums: the last minute in blocks, and all before it as reference,
/// which forgets within an hour. Every new block is looked at together with those before it, in
/// windows of 2 to 24 blocks: an alarm is where one explanation of a window lies far beyond chance,
/// and beyond what that window of the unchanged vehicle gives. Allocates at construction only.
class Watch {
 public:
  static constexpr std::size_t kBlocks = 24;  ///< that are kept one by one

  /// Of the vehicle that Diagnosis is constructed for.
  Watch(std::size_t inputs, std::span<const std::size_t> states,
        std::vector<std::size_t> body_axes);

  const Basis& basis() const { return basis_; }                       ///< The terms.
  const Explanations& explanations() const { return explanations_; }  ///< All causes.
  const ReferenceFit& fit() const { return fit_; }  ///< Of the reference at the last block.
  std::span<const double> directions() const { return directions_; }  ///< … of explanations.
  Comparison& comparison() { return comparison_; }                    ///< That was made last.

  bool ready() const;  ///< Whether the reference has rows enough to compare with.

  /// The newest block of rows, the first of them at `start_s`. Begins to look at the windows.
  void keep(const Sums& block, double start_s);
  /// Looks at one window, the shortest first. Whether all have been looked at and there is an
  /// alarm; then part() or keep() has to follow. Cost: O(terms³).
  bool step();
  /// Where rows are parted.
  struct Part {
    double since_s;      ///< time of the first row after the cut
    std::size_t blocks;  ///< that came after it, those of the guard included
  };
  /// After an alarm: where is the cut that explains most? Blocks before it go to the reference;
  /// those after it, without the first `guard`, are added to `after`. Forgets the blocks.
  Part part(std::size_t guard, Sums& after);
  void drop_since(double t);  ///< Forgets the blocks with rows later than that.

  /// Compares rows with the reference; comparison() tells.
  void compare(const Sums& stretch);
  double usual_scatter() const;  ///< Of a minute of the unchanged vehicle; 1: as independent noise.

  /// The vehicle is now another: its coefficients are `delta` greater (empty: not known), of the
  /// reference a share is kept, and `rows` are of the vehicle as it is now.
  void go_on(std::span<const double> delta, double kept, const Sums& rows);

  const std::vector<Cause>& health() const { return health_; }  ///< Diagnosis::health().

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  void absorb_oldest();
  void take_newest(std::size_t from, std::size_t to);
  void weigh(std::size_t window);
  void tell_health();
  std::size_t sharpest_cut();

  Basis basis_;
  Explanations explanations_;
  ReferenceFit fit_;
  Comparison comparison_;
  Sums reference_, window_sums_;
  std::vector<Sums> blocks_;    // the oldest at first_
  std::vector<double> starts_;  // times of their first rows
  std::size_t first_ = 0, kept_ = 0;
  std::size_t window_;         // the next to be looked at
  std::size_t alarm_ = 0;      // the window that disagrees most, from 1; 0: none does
  double alarm_excess_ = 0.0;  // … and by how much
  std::size_t watched_ = 0;    // blocks that have been looked at
  std::vector<double> usual_;  // of windows × explanations and refit: scatter without a change
  std::vector<double> directions_;
  std::vector<std::size_t> health_columns_;
  std::vector<Cause> health_;
};

}  // namespace kelpie
