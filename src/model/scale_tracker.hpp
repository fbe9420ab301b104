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
#include "kelpie/online/sample_collector.hpp"
#include "model/warm_up.hpp"

namespace kelpie {

/// The scale of one axis: given, or measured on the samples so far (of more than 1,000 the latest
/// count most). A scale that was measured is taken anew when the samples have outgrown it by the
/// ratio `track`; a few times in a life. It never shrinks: a calm stretch is no smaller vehicle. It
/// tells when it is time (next()); its owner goes over (adopt()).
///
/// It also tells which samples are plausible. One that lies more than kFar deviations away is not,
/// unless many are: each implausible sample lets the next be farther away, fourfold from the third
/// on. So one absurd row, or two, touch nothing, and a vehicle that sets off after a long rest is
/// believed after a few samples.
class ScaleTracker {
 public:
  /// Requires inputs <= kMostInputs, and a scaling that was made for these inputs and terms.
  ScaleTracker(std::size_t inputs, const SharedSettings& settings, TermSet terms,
               std::optional<AxisScaling> given);

  std::size_t inputs() const { return inputs_; }
  const TermSet& terms() const { return terms_; }

  /// The scale in use; null before the first adopt(), unless one was given.
  const AxisScaling* scaling() const { return scaling_ ? &*scaling_ : nullptr; }

  /// Whether a sample is to be believed; to be asked once per sample. Always, where the scale isn't
  /// followed (`track` 0). Requires scaling().
  bool plausible(std::span<const double> x, double y);

  /// Counts one more sample, where it can still have a say. Cost O(d² + m²) for m terms. Allocates
  /// nothing.
  void observe(std::span<const double> x, double y);

  void restart();  ///< Forgets the samples counted.

  /// Goes on with a scale that earlier samples gave; it is followed as if it had come from 250.
  /// Requires that none was given, and no samples yet. Allocates.
  void resume_from(AxisScaling scaling);

  /// Mean of the targets counted; 0 before the first.
  double mean_target() const;

  /// The scale to go over to now, if any. The first one: as soon as the samples determine it (an
  /// input moves and the target does). Later ones: looked for at every 64th sample, and at once
  /// when what seemed implausible was believed, but not on the way to one. Null: none; valid until
  /// the next call. Allocates nothing, but with ScalingKind::full.
  const AxisScaling* next();

  void set_out() { move_ = Move::coming; }  ///< What next() gave stays until arrive().
  void adopt();  ///< What next() gave is in use from now on. Allocates at the first time.
  void arrive() { move_ = Move::none; }  ///< Looks for further scales again.

  bool on_the_way() const { return move_ != Move::none; }  ///< Between set_out() and arrive().
  /// Between adopt() and arrive(): the scale that was in use before; else null.
  const AxisScaling* before() const { return move_ == Move::adopted ? &next_ : nullptr; }

  /// On the way: puts a sample of the scale before into the one after. Requires that this stays
  /// where it is.
  SampleMap map() const;

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  enum class Move : std::uint8_t { none, coming, adopted };

  bool measure();
  bool outgrown(const AxisScaling& scaling) const;
  bool counts() const { return !given_ && (!scaling_ || track_ > 0.0); }

  std::size_t inputs_;
  ScalingKind kind_;
  double track_;  ///< 0: the scale stays
  bool given_;
  TermSet terms_;
  Moments input_moments_;  ///< none of the three are counted where the scale was given
  Moments target_moments_;
  Moments term_moments_;
  std::vector<double> term_values_;  ///< scratch
  std::int64_t observed_ = 0;
  int implausible_ = 0;  ///< how many samples were, lately
  bool widened_ =
      false;  ///< the last sample was believed because others before it were as far away
  std::optional<AxisScaling> scaling_;
  AxisScaling next_;  ///< the one to come; adopted: the one before
  Move move_ = Move::none;
};

/// Which of these samples, held back before there is a scale, are plausible: none of their values
/// lies ten times as far from the median as those between the 5th and the 95th percentile do.
/// Allocates.
std::vector<bool> plausible_samples(const WarmUp& samples, std::size_t inputs);

}  // namespace kelpie
