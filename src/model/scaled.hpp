// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "kelpie/online/regressor.hpp"
#include "model/scale_tracker.hpp"
#include "model/warm_up.hpp"

namespace kelpie {

/// An axis in the units of the log, whose learner wants scaled samples: scaled inputs, then scaled
/// physics terms (TermSet), and a standardised target. Where no scaling is given, it is taken from
/// the first samples: these are held back until there are `warmup` of them and they determine a
/// scale. (As long as nothing moves it waits; then the last `warmup` samples give the scale. An
/// input that hasn't moved is left out until it does.) From then on they are learned, a few with
/// every update, and those that come meanwhile after them. The scale is followed, and implausible
/// samples are turned away (ScaleTracker). Decisions and predictions are in raw units, but for the
/// KKT gap. A derived class owns the learner.
class Scaled : public OnlineRegressor {
 public:
  /// Allocates while samples are held back, when the scale is found, and nothing from then on (but
  /// with `scaling = full` where it is followed, at every 64th sample).
  Decision update(std::span<const double> x, double y, double t) override;
  void alert(double since_s, bool another) override { learner().alert(since_s, another); }

  /// As far as the scale is known.
  void learn_held_back() override;

  /// Before there is a scale: the mean of the targets so far (0 at the very start).
  double predict(std::span<const double> x) const override;

  Status status() const override;

  std::size_t inputs() const { return scale_.inputs(); }
  /// Null while samples are held back.
  const AxisScaling* scaling() const { return scale_.scaling(); }
  const TermSet& terms() const { return scale_.terms(); }

 protected:
  /// Requires inputs <= kMostInputs.
  Scaled(std::size_t inputs, const SharedSettings& settings, TermSet terms,
         std::optional<AxisScaling> scaling);

  /// ScaleTracker::resume_from(); no samples are held back then.
  void resume_from(const AxisScaling& scaling) { scale_.resume_from(scaling); }

  /// The scale before, as long as the learner keeps something in it; else null.
  const AxisScaling* before_scaling() const { return scale_.before(); }

  void visit(Archive& archive);  ///< core/archive.hpp; without the learner

 private:
  virtual OnlineRegressor& learner() = 0;
  virtual const OnlineRegressor& learner() const = 0;

  /// The scale is known now, and nothing has been learned yet.
  virtual void scale_found() {}

  /// The learner goes over to another scale, a slice of the work (AdaptiveSvr::rescale).
  virtual RescaleStatus rescale(const SampleMap& /*map*/) { return RescaleStatus::refused; }

  Decision hold_back(std::span<const double> x, double y, double t);
  Decision stand_in_line(std::span<const double> x, double y, double t);
  bool find_scale();
  void learn_held(Decision& decision);
  Decision learn(const AxisScaling& scaling, std::span<const double> x, double y, double t);
  void follow(std::span<const double> x, double y);

  ScaleTracker scale_;
  WarmUp warm_up_;
  std::int64_t invalid_ = 0;
  std::int64_t implausible_ = 0;
  std::int64_t held_ = 0;  ///< since there were as many as `warmup`
};

}  // namespace kelpie
