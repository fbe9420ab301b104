// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "kelpie/svr/online_svr.hpp"
#include "kelpie/svr/resources.hpp"
#include "learner/change_detector.hpp"
#include "learner/past_models.hpp"
#include "learner/term_change.hpp"
#include "svr/robust_scale.hpp"
#include "svr/sample_collector.hpp"
#include "svr/svr_function.hpp"

namespace kelpie {

/// The paper's learner for one axis with detection of changes of the vehicle, on scaled inputs. The
/// champion is the OnlineSvr in service. When the champion's errors grow, a challenger, an
/// OnlineSvr without samples, starts to learn beside the champion. A challenger with much smaller
/// errors (ChangeDetector) becomes the champion, and all older samples are forgotten at once. Past
/// models are kept (PastModels); a past model that fits again becomes the champion. With
/// `adapt = none` the champion works alone.
///
/// The challenger's place also serves for long tasks, a slice with every update: the change to
/// another scale and the recall of a past model. The champion stays in service meanwhile. During a
/// task no challenger is tried, no past model is recalled, and no other task begins.
///
/// A change of the vehicle may be known as a step of the terms' weights (shift()). The samples then
/// stay as they are: the champion learns later targets less the change since its samples
/// (TermChange), and model() adds the change. Past models are of the vehicle itself.
///
/// Real time: as OnlineSvr. With a challenger an update costs about twice as much. Champion,
/// challenger and task have the budget's steps each; they share clock and work.
/// Memory: bytes(), two OnlineSvr, the past models, and one past model more.
class AdaptiveSvr final : public OnlineRegressor {
 public:
  /// The long work in the challenger's place.
  enum class SliceTask : std::uint8_t {
    none,
    rescale,   ///< the challenger learns the champion's samples in another scale
    catch_up,  ///< the challenger learns the samples that the champion has learned meanwhile
    follow,    ///< the past models are moved to the other scale, one after the other
    recall,    ///< the challenger learns the samples of a past model
  };

  /// A sample consists of `inputs` scaled inputs and `terms` scaled physics terms. Throws
  /// InputError on settings that do not validate.
  AdaptiveSvr(std::size_t inputs, const OnlineSvrSettings& settings, std::size_t terms = 0);

  /// Sets the budget of every further update; a default budget is unlimited.
  void limit(const Budget& budget);

  Decision update(std::span<const double> z, double y, double t) noexcept override {
    return update(z, y, t, std::numeric_limits<double>::infinity());
  }
  /// The update of a member of a committee. `committee_error`: |error| of the committee without the
  /// short-range kernel part. No change is confirmed while the committee's errors stay small.
  Decision update(std::span<const double> z, double y, double t, double committee_error) noexcept;

  /// Tries the past models at once and halves the evidence that a challenger needs.
  void alert(double since_s, bool another) noexcept override {
    past_models_.alert(since_s, another);
    detector_.expect_change();
  }
  double predict(std::span<const double> z) const noexcept override;
  Status status() const override;

  /// Follows a change of the vehicle by a known step of the terms' weights; the last number is of
  /// the bias. An empty step: the scale of the samples has followed the change, so function, buffer
  /// and past models hold as they are. `news`: `changed` with `changed_since` at the first step,
  /// `withdrawn` at the last. Requires `adapt = challenger`. Cost O(n inputs). Allocates nothing.
  void shift(std::span<const double> step, const Decision& news);

  /// KernelDensity::novelty() of a sample's inputs in the champion's buffer. Cost: two kernel rows.
  double novelty(std::span<const double> z) const {
    return kelpie::novelty(champion().buffer(), z);
  }

  /// Moves to another scale by `map`, one slice per call. To be called before every update with
  /// the same map until the result is `done`. The champion's samples come first, then the samples
  /// learned meanwhile, then, after the switch, the past models. A trial under way ends. With
  /// `adapt = none` the first call does all work (OnlineSvr::rescale). Allocates nothing.
  RescaleStatus rescale(const SampleMap& map);

  /// Number of past models, counted from the first, in the scale of the samples.
  std::size_t rescaled() const {
    return task_ == SliceTask::follow ? past_ : past_models_.models().size();
  }

  /// core/archive.hpp. The challenger is part of the state only while its place is used.
  void visit(Archive& archive);

  /// Adds a past model of another source; its samples are learned with the present settings. False
  /// without room. Requires a model for such a buffer, and a learner without samples. Cost as
  /// rescale().
  bool add_past(const PastModel& past);

  /// Resumes learning from the samples of a past model: OnlineSvr::relearn().
  void resume_from(const PastModel& past, double now) {
    mutable_champion().relearn(past, now);
    misfit_.clear();
  }

  const PastModels& past_models() const { return past_models_; }
  const ChangeDetector& detector() const { return detector_; }
  SliceTask task() const { return task_; }

  const OnlineSvr& champion() const { return learners_[champion_]; }

  /// The function of the vehicle as known now.
  const SvrFunction& model() const {
    return change_[champion_].any() ? model_ : champion().model();
  }

  /// Change of the vehicle since the champion's samples.
  const TermChange& change() const { return change_[champion_]; }

  /// Memory of a learner in bytes, known before construction. Requires settings that validate.
  static std::size_t bytes(std::size_t inputs, const OnlineSvrSettings& settings,
                           std::size_t terms = 0);

 private:
  const OnlineSvrSettings& settings() const { return champion().settings(); }
  OnlineSvr& mutable_champion() { return learners_[champion_]; }
  OnlineSvr& challenger() { return learners_[1 - champion_]; }
  double error_without_short_range(std::size_t learner, std::span<const double> z, double y) const;
  void clear_challenger();
  void add_change();
  bool teach_challenger(std::span<const double> z, double y, double t);
  void measure_misfit();
  double usual_misfit() const;
  void detect_change(Decision& decision, const ChangeDetector::Errors& errors, double t);
  void manage_past_models(Decision& decision, double t);
  void declare_change(Decision& decision, double since);
  void promote(Decision& decision);
  void start(SliceTask task);
  void recall(Decision& decision);
  RescaleStatus rescale_at_once(const SampleMap& map);
  RescaleStatus catch_up(const SampleMap& map);
  RescaleStatus follow(const SampleMap& map);
  void visit_task(Archive& archive);

  std::vector<OnlineSvr> learners_;  ///< one, or two with adapt = challenger
  std::vector<TermChange> change_;   ///< of each learner
  std::size_t champion_ = 0;
  SvrFunction model_;  ///< the champion's, with the change; without a change of no use
  ChangeDetector detector_;
  PastModels past_models_;
  RobustScale misfit_;          ///< residuals in the champion's own buffer, without short range
  std::vector<double> sample_;  ///< scratch
  Tally tally_;                 ///< over all champions
  Budget budget_;               ///< of every update

  SliceTask task_ = SliceTask::none;
  PastModel draft_;            ///< rescale: the champion's samples at the start of the task
  std::uint64_t learned_ = 0;  ///< catch_up: champion's arrivals below this number are learned
  std::size_t past_ = 0;       ///< follow, recall: the number of the past model
  double begun_s_ = 0.0;       ///< recall: start of the task [s]
  double since_s_ = 0.0;       ///< recall: start of the grown errors [s]
};

}  // namespace kelpie
