// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// The outcome of the including node for one sample.
enum class Verdict : std::uint8_t {
  accepted,     ///< added to the buffer and learned
  explained,    ///< rejected by eq. (9): close to a sample kept, and inside the tube
  duplicate,    ///< rejected by eq. (10): close to a sample kept with the same target
  invalid,      ///< rejected: a NaN, a value beyond ±1e50, or a wrong number of inputs
  held_back,    ///< stored until the scale of the data is known, then learned
  implausible,  ///< rejected: too far from all earlier samples
  crowded_out,  ///< rejected: Budget or WorkLimit was spent on earlier samples
};

/// A predicted value with its uncertainty, in the unit of the target.
struct Prediction {
  double value = 0.0;
  /// Ends of the interval that contains the truth of the next sample with the promised probability;
  /// infinite without such a promise.
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  /// Fraction of the buffer's samples in a denser place (KernelDensity::novelty), 0 to 1; NaN where
  /// unknown, as in a Decision.
  double novelty = std::numeric_limits<double>::quiet_NaN();
  /// Contribution of the present disturbance, to be added to `value` (Disturbance); 0 without an
  /// estimate.
  double disturbance = 0.0;
  /// Ends of the interval around `value` + `disturbance`.
  double corrected_lower = -std::numeric_limits<double>::infinity();
  double corrected_upper = std::numeric_limits<double>::infinity();
};

/// The result of one update: how the nodes processed the sample. Tally sums the
/// counts over a stream.
struct Decision {
  Verdict verdict = Verdict::accepted;
  /// By the model in service before the sample was learned; NaN for an invalid sample.
  Prediction prediction{};
  bool had_model = false;   ///< a model was in service; without one the prediction is a mean
  double similarity = 0.0;  ///< largest κ_SE to a sample in the buffer, before learning
  int outliers = 0;         ///< samples rejected as outliers in this step
  int forgotten = 0;        ///< samples removed from a full buffer
  int released = 0;         ///< samples removed because their weight had become 0
  int iterations = 0;       ///< solver iterations, summed over the solves of this step
  double kkt_gap = 0.0;     ///< after this step, in units of the standardised target
  bool published = false;   ///< a newly trained model went into service (gap within tolerance)
  bool rejected_by_tolerance = false;  ///< the training ended outside the tolerance
  bool unfinished = false;  ///< Budget or WorkLimit exhausted; the next update continues the work
  int fallbacks = 0;        ///< solves in which SMO replaced the path solver
  bool changed = false;     ///< a change of the vehicle was found, and the model follows
  double changed_since = 0.0;  ///< start of the change [s], with `changed`
  bool withdrawn = false;      ///< the last change was an error: the model goes back
  bool returning = false;      ///< a past vehicle has returned
  std::int64_t recalled = 0;   ///< number of the past vehicle that has returned, or 0
};

/// Sums of the decisions of a stream since the start; tally_fields() has the meanings. Every
/// `accepted` sample of the paper's learner is in the buffer or in `outliers`, `forgotten` or
/// `released`. No total ever decreases.
struct Tally {
  std::int64_t accepted = 0;
  std::int64_t explained = 0;
  std::int64_t duplicate = 0;
  std::int64_t invalid = 0;
  std::int64_t implausible = 0;
  std::int64_t outliers = 0;
  std::int64_t forgotten = 0;
  std::int64_t released = 0;
  std::int64_t rejected_by_tolerance = 0;
  std::int64_t crowded_out = 0;
  std::int64_t unfinished = 0;
  std::int64_t fallbacks = 0;
  std::int64_t changes = 0;
  std::int64_t recalls = 0;
  std::int64_t withdrawn = 0;

  void add(const Decision& decision);   ///< Counts one step.
  void add(const Tally& other);         ///< Adds the totals of another stretch.
  void subtract(const Tally& earlier);  ///< Leaves the totals since `earlier`.
  void visit(Archive& archive);         ///< core/archive.hpp
};

/// Kind of a total. Pages show the totals in this order.
enum class TallyKind : std::uint8_t {
  arrival,    ///< arriving samples by verdict, without held samples
  departure,  ///< samples removed from the buffer
  trouble,    ///< effects of a budget, and solver failures
  change,     ///< changes of the vehicle
};

/// A total: the source of archive, result.json, pages, tables and Python.
struct TallyField {
  std::string_view key;      ///< in result.json
  std::string_view name;     ///< in Python
  std::string_view label;    ///< in pages and tables
  std::string_view meaning;  ///< a line of help
  TallyKind kind;
  std::int64_t Tally::*total;
  std::int64_t (*count)(const Decision& decision);  ///< contribution of a step
};

/// The totals, in the order of result.json.
std::span<const TallyField> tally_fields();

}  // namespace kelpie
