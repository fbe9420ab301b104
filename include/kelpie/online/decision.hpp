// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

namespace kelpie {

/// What became of a sample when it came.
enum class Verdict : std::uint8_t {
  accepted,     ///< taken into the buffer and trained on
  explained,    ///< turned away by eq. (9): close to a support vector and within the tube
  duplicate,    ///< turned away by eq. (10): close to a support vector with the same target
  invalid,      ///< turned away: a NaN, beyond ±1e50, or the wrong number of inputs
  held_back,    ///< kept aside until the scale of the data is known; learned then
  implausible,  ///< turned away: too far from all samples before to be believed
  crowded_out,  ///< turned away: the budget or WorkLimit went on earlier samples
};

/// What happened to one sample on its way through the nodes. What is summed up over a stream is
/// said in online/tally.hpp.
struct Decision {
  Verdict verdict = Verdict::accepted;
  double predicted = 0.0;  ///< what the model in service said before this sample was learned
  bool had_model = false;  ///< whether a model was in service then; else `predicted` is a mean
  /// The interval around `predicted` that was in force before this sample was learned; infinite
  /// where nothing was promised.
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  /// What the disturbance then present added to `predicted` (online/disturbance.hpp); 0 from who
  /// doesn't estimate it. And the interval around the sum.
  double disturbance = 0.0;
  double corrected_lower = -std::numeric_limits<double>::infinity();
  double corrected_upper = std::numeric_limits<double>::infinity();
  double similarity = 0.0;  ///< highest κ_SE to a sample in the buffer, before it was learned
  int outliers = 0;         ///< samples rejected as outliers at this step
  /// Samples that left because the buffer was full, or another model took over that has fewer.
  int forgotten = 0;
  int released = 0;        ///< samples that left because they had lost their weight
  int regained = 0;        ///< samples that came with another model that took over
  int iterations = 0;      ///< of the solver, all solves of this step together
  double kkt_gap = 0.0;    ///< after this step, in units of the standardised target
  bool published = false;  ///< whether the model trained now went into service (gap in tolerance)
  bool rejected_by_tolerance = false;  ///< the training ended out of tolerance
  bool unfinished = false;     ///< budget or WorkLimit ran out; the next call goes on with the work
  int fallbacks = 0;           ///< solves in which the solver gave up and SMO took over
  bool suspected = false;      ///< errors have grown: a challenger is tried from now on
  bool changed = false;        ///< the vehicle was found to have changed: another model took over
  double changed_since = 0.0;  ///< when errors began to grow [s], where `changed` or `returning`
  bool withdrawn = false;      ///< the last change was none: the model before took over again
  bool returning = false;      ///< a past model fits, and will be taken up over the next updates
  std::int64_t recalled = 0;   ///< the number of the past model taken up (PastModels), or 0
};

}  // namespace kelpie
