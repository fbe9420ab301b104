// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "kelpie/online/change_detector.hpp"
#include "kelpie/online/online_svr.hpp"
#include "kelpie/online/past_models.hpp"
#include "kelpie/online/robust_scale.hpp"

namespace kelpie {

/// The paper's learner for one axis that also notices when the vehicle has changed, on scaled
/// inputs. The champion is an OnlineSvr and does everything. When its errors grow, a challenger, an
/// OnlineSvr that knows nothing, starts to learn beside it. If the challenger turns out to be
/// better by far (ChangeDetector), it becomes the champion, and all that was learned before is
/// forgotten at once. Past models are kept (PastModels). When one of them fits again, it becomes
/// the champion: the vehicle is back. With `adapt = none` there is the champion alone.
///
/// The long jobs, another scale and taking up a past model, are done in the challenger's place, a
/// slice with every update, while the champion stays in service. One job is finished before
/// another begins: until then no challenger is tried, and no past model taken up.
///
/// Real time: as OnlineSvr. While a challenger is tried an update costs about twice as much, and
/// each of the two has a budget's steps for itself, as has a job; clock and work are shared.
/// Memory: bytes(), that of two OnlineSvr and of the past models, and one more.
class AdaptiveSvr final : public OnlineRegressor {
 public:
  /// A sample is `inputs` scaled inputs followed by `terms` scaled physics terms. Throws InputError
  /// on settings that don't validate.
  AdaptiveSvr(std::size_t inputs, const OnlineSvrSettings& settings, std::size_t terms = 0);

  /// What every update from now on may spend; a default one never ends.
  void limit(const Budget& budget);

  Decision update(std::span<const double> z, double y, double t) noexcept override {
    return update(z, y, t, std::numeric_limits<double>::infinity());
  }
  /// The same beside others who learn the sample, too: `committee_error` is the error of what all
  /// together said of it, without the fine part. It is no change that they foretell.
  Decision update(std::span<const double> z, double y, double t, double committee_error) noexcept;

  /// The past models are tried at once, and a challenger needs less evidence.
  void alert(double since_s, bool another) noexcept override {
    memory_.alert(since_s, another);
    detector_.expect_change();
  }
  double predict(std::span<const double> z) const noexcept override;
  Status status() const override;

  /// KernelDensity::novelty() of a sample's inputs among the champion's buffer. Cost: two kernel
  /// rows.
  double novelty(std::span<const double> z) const { return champion().buffer().novelty(z); }

  /// Goes over to another scale, which `map` leads to: a slice of the work. To be called before
  /// every update from then on, with the same map, until it says `done`. The champion's samples
  /// come first, then those it has learned meanwhile; where that has arrived the past models
  /// follow. A trial that is under way ends. With `adapt = none` all is done at once
  /// (OnlineSvr::rescale). Allocates nothing.
  RescaleStatus rescale(const SampleMap& map);

  /// How many of memory()'s models, the first ones, are in the scale that samples come in.
  std::size_t rescaled() const {
    return task_ == SliceTask::follow ? past_ : memory_.models().size();
  }

  /// core/archive.hpp. The challenger is part of the state only while its place is used.
  void visit(Archive& archive);

  /// Adds a past model from elsewhere to the memory; its samples are learned with these settings.
  /// False when there is no room. Requires one made for such a buffer, and that nothing has been
  /// learned yet. Cost as rescale().
  bool add_past(const PastModel& past);

  /// The champion goes on with the samples of a past model: OnlineSvr::relearn().
  void resume_from(const PastModel& past, double now) {
    champion().relearn(past, now);
    misfit_.clear();
  }

  const PastModels& memory() const { return memory_; }

  const OnlineSvr& champion() const { return learners_[champion_]; }
  const OnlineSvrSettings& settings() const { return champion().settings(); }
  const SvrFunction& model() const { return champion().model(); }

  /// All memory of a learner in bytes, known before there is one. Requires settings that validate.
  static std::size_t bytes(std::size_t inputs, const OnlineSvrSettings& settings,
                           std::size_t terms = 0);

 private:
  static constexpr std::size_t kLeastMisfits = 50;  ///< before they tell anything

  /// What goes on in the challenger's place instead of a trial.
  enum class SliceTask : std::uint8_t {
    none,
    rescale,   ///< the champion's samples are learned in another scale
    catch_up,  ///< … and what the champion has learned meanwhile
    follow,    ///< past models are learned in the other scale, one after the other
    recall,    ///< a past model is taken up
  };

  OnlineSvr& champion() { return learners_[champion_]; }
  OnlineSvr& challenger() { return learners_[1 - champion_]; }
  static double error_without_short_range(const OnlineSvr& learner, std::span<const double> z,
                                          double y);
  bool teach_challenger(std::span<const double> z, double y, double t);
  void measure_misfit();
  double usual_misfit() const;
  void detect_change(Decision& decision, const ChangeDetector::Errors& errors, double t);
  void manage_past_models(Decision& decision, double t);
  void start(SliceTask task);
  void recall(Decision& decision);
  RescaleStatus rescale_at_once(const SampleMap& map);
  RescaleStatus catch_up(const SampleMap& map);
  RescaleStatus follow(const SampleMap& map);
  void visit_task(Archive& archive);
  void declare_change(Decision& decision, double since);
  void promote(Decision& decision);

  std::vector<OnlineSvr> learners_;  ///< one, or two with adapt = challenger
  std::size_t champion_ = 0;
  ChangeDetector detector_;
  PastModels memory_;
  RobustScale misfit_{kLeastMisfits, 16};  ///< of the champion's lasting part in its own buffer
  std::vector<double> sample_;             ///< scratch
  Tally tally_;                            ///< over all champions
  Budget budget_;                          ///< of every update

  SliceTask task_ = SliceTask::none;
  PastModel draft_;            ///< rescale: the champion's samples as the job began
  std::uint64_t learned_ = 0;  ///< catch_up: the arrivals in the champion's buffer before this one
  std::size_t past_ = 0;       ///< follow, recall: which past model
  double begun_s_ = 0.0;       ///< recall: when the job began [s]
  double since_s_ = 0.0;       ///< recall: when the vehicle came back [s]
};

}  // namespace kelpie
