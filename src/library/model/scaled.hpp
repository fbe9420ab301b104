// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "kelpie/svr/regressor.hpp"
#include "model/scale_tracker.hpp"
#include "model/thinned_rows.hpp"
#include "model/warm_up.hpp"

namespace kelpie {

/// An axis in the units of the log around a learner of scaled samples: scaled inputs, scaled
/// physics terms (TermSet), standardised target. Without a given scaling, the first samples are
/// held back until `warmup` samples determine a scale. While all inputs are constant, the axis
/// waits; then the last `warmup` samples give the scale. A constant input is left out until it
/// moves. Once the scale is known, the held samples are learned in order, a few per update; new
/// samples are queued behind them. The scale follows the data (ScaleTracker).  Decisions and
/// predictions are in raw units, except the KKT gap. A derived class owns the learner.
class Scaled : public OnlineRegressor {
 public:
  /// Allocates while samples are held back and when the scale is found; later nothing, except with
  /// `scaling = full` and `track` > 0 at every 64th sample.
  Decision update(std::span<const double> x, double y, double t) override;
  void alert(double since_s, bool another) override { learner().alert(since_s, another); }

  /// Learns all held samples, once the scale is known.
  void learn_held_back() override;

  /// Before the scale is known: the mean of the targets so far (0 at the start).
  double predict(std::span<const double> x) const override;

  Status status() const override;

  std::size_t inputs() const { return scale_.inputs(); }
  /// Null while samples are held back.
  const AxisScaling* scaling() const { return scale_.scaling(); }
  const TermSet& terms() const { return scale_.terms(); }

  /// Whether a sample is plausible, and whether inputs are far away (ScaleTracker). Require
  /// scaling().
  bool plausible(std::span<const double> x, double y) const { return scale_.plausible(x, y); }
  bool far(std::span<const double> x) const { return scale_.far(x); }

  /// The scale is to suit further samples, those from `first` on, which count as much as all
  /// samples so far: learns the scale alone. Requires scaling(). Allocates nothing.
  void expect(const ThinnedRows& samples, std::size_t first);

  /// Whether first samples are held back that the learner has still to learn.
  bool holds_back() const { return scaling() == nullptr || warm_up_.size() > 0; }

  bool changes_scale() const { return scale_.on_the_way(); }  ///< A change of scale is under way.

  /// Whether the next scale is not in use yet: a sample is learned in the scale that is too small.
  bool awaits_scale() const { return changes_scale() && before_scaling() == nullptr; }

  /// A slice of a change of scale: of the change under way, or of one that is due. update() does
  /// the same. Requires scaling(). Allocates as update().
  void change_scale();

 protected:
  /// Requires inputs <= kMostInputs.
  Scaled(std::size_t inputs, const SharedSettings& settings, TermSet terms,
         std::optional<AxisScaling> scaling);

  /// ScaleTracker::amplify(). The caller tells the learner.
  void amplify(const CommandGain& gain) { scale_.amplify(gain); }

  /// ScaleTracker::resume_from(); no samples are held back.
  void resume_from(const AxisScaling& scaling) { scale_.resume_from(scaling); }

  /// The previous scale during a change of scale; else null.
  const AxisScaling* before_scaling() const { return scale_.before(); }

  void visit(Archive& archive);  ///< core/archive.hpp; without the learner

 private:
  virtual OnlineRegressor& learner() = 0;
  virtual const OnlineRegressor& learner() const = 0;

  /// Called when the scale is found, before the first sample is learned.
  virtual void scale_found() {}

  /// The learner goes over to another scale, a slice of the work (AdaptiveSvr::rescale).
  virtual RescaleStatus rescale(const SampleMap& /*map*/) { return RescaleStatus::refused; }

  Decision hold_back(std::span<const double> x, double y, double t);
  Decision stand_in_line(std::span<const double> x, double y, double t);
  bool find_scale();
  void learn_held(Decision& decision);
  Decision learn(const AxisScaling& scaling, std::span<const double> x, double y, double t);

  ScaleTracker scale_;
  WarmUp warm_up_;
  std::int64_t invalid_ = 0;
  std::int64_t implausible_ = 0;  ///< among the first samples
  std::int64_t held_ = 0;         ///< samples since `warmup` samples were held
};

}  // namespace kelpie
