// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kelpie/core/scaling.hpp"
#include "kelpie/model/settings.hpp"
#include "kelpie/motion/term_set.hpp"
#include "model/command_gain.hpp"
#include "model/warm_up.hpp"
#include "svr/sample_collector.hpp"

namespace kelpie {

/// The scale of one axis: given, or measured on the samples so far (beyond 1,000 samples the latest
/// count most). A measured scale is renewed when the samples outgrow it by the ratio `track`, a few
/// times in a life. The scale never decreases, so that a calm period does not rescale the data.
/// next() offers a new scale; the owner switches with adopt().
///
/// A target or input more than 10 standard deviations away is implausible, except an input that was
/// held (deviation below a tenth of its largest magnitude so far) and stays within three times this
/// magnitude: the standard deviation of a command that is constant for minutes, or of a cruising
/// speed, says nothing of the next step. GuardedAxis keeps implausible samples from the axis, or
/// lets a candidate learn them.
class ScaleTracker {
 public:
  /// Requires inputs <= kMostInputs, and a given scaling of these inputs and terms.
  ScaleTracker(std::size_t inputs, const SharedSettings& settings, TermSet terms,
               std::optional<AxisScaling> given);

  std::size_t inputs() const { return inputs_; }
  const TermSet& terms() const { return terms_; }

  /// The scale in use; null before the first adopt() of a scale that is measured.
  const AxisScaling* scaling() const { return scaling_ ? &*scaling_ : nullptr; }

  /// Whether a sample is plausible. Requires scaling().
  bool plausible(std::span<const double> x, double y) const;

  /// Whether inputs are more than 10 standard deviations away, or one moves that never did.
  /// Requires scaling().
  bool far(std::span<const double> x) const { return any_far(x, false); }

  /// Adds a sample to the statistics, unless the scale is final. Cost O(d² + m²) for m terms.
  /// Allocates nothing.
  void observe(std::span<const double> x, double y);

  void restart();  ///< Discards the statistics.

  /// The samples observed so far count as at most `count` samples from now on. Requires
  /// count >= 2.
  void lighten(std::size_t count);

  /// Continues with the scale of a trained model, which counts as a scale of 250 samples. Requires
  /// no given scale and no samples yet. Allocates.
  void resume_from(AxisScaling scaling);

  /// Mean of the targets so far; 0 before the first.
  double mean_target() const;

  /// The next scale, or null; valid until the next call. The first scale comes when the samples
  /// determine it (an input and the target move). Later scales are looked for at every 64th sample,
  /// and at once after a sample so far away, but not during a change of scale. Allocates nothing,
  /// except with ScalingKind::full.
  const AxisScaling* next();

  /// The vehicle moves as if a command were `factor` times what the command is: the scale maps x_i
  /// as it mapped factor · x_i before. Statistics are of the log, and stay. Requires scaling().
  void amplify(const CommandGain& gain);

  void set_out() { move_ = Move::coming; }  ///< Starts a change to the scale of next().
  void adopt();  ///< Puts the scale of next() in use. The first call allocates.
  void arrive() { move_ = Move::none; }  ///< Ends the change of scale.

  bool on_the_way() const { return move_ != Move::none; }  ///< Between set_out() and arrive().
  /// Between adopt() and arrive(): the previous scale; else null.
  const AxisScaling* before() const { return move_ == Move::adopted ? &next_ : nullptr; }

  /// During a change: maps a sample of the previous scale into the next. Refers to this object.
  SampleMap map() const;

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  enum class Move : std::uint8_t { none, coming, adopted };

  bool far(double y) const;
  bool any_far(std::span<const double> x, bool but_held) const;
  void see(std::span<const double> x);
  void see(const InputScaling& scaling);
  bool measure();
  bool outgrown(const AxisScaling& scaling) const;
  bool counts() const { return !given_ && (!scaling_ || track_ > 0.0); }

  std::size_t inputs_;
  ScalingKind kind_;
  double track_;  ///< 0: the scale stays
  bool given_;
  TermSet terms_;
  Moments input_moments_;  ///< all three unused with a given scale
  Moments target_moments_;
  Moments term_moments_;
  std::vector<double> term_values_;  ///< scratch
  std::vector<double> largest_;      ///< magnitude of each input in samples that were not far away
  std::int64_t observed_ = 0;
  bool far_ = false;  ///< the last sample was more than 10 standard deviations away
  std::optional<AxisScaling> scaling_;
  AxisScaling next_;  ///< the next scale; after adopt(): the previous
  Move move_ = Move::none;
};

/// Which held-back samples are plausible: no value lies ten times as far from the median as the 5th
/// or 95th percentile; no input's value has three times the 95th percentile of magnitudes besides.
/// Allocates.
std::vector<bool> plausible_samples(const WarmUp& samples, std::size_t inputs);

}  // namespace kelpie
