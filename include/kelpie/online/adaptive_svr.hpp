// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kelpie/online/change_detector.hpp"
#include "kelpie/online/model_memory.hpp"
#include "kelpie/online/online_svr.hpp"
#include "kelpie/online/robust_scale.hpp"

namespace kelpie {

/// The paper's learner for one axis that also notices when the vehicle has changed, on scaled
/// inputs. The champion is an OnlineSvr and does everything. When its errors grow, a challenger, an
/// OnlineSvr that knows nothing, starts to learn beside it. If the challenger turns out to be
/// better by far (ChangeDetector), it becomes the champion, and all that was learned before is
/// forgotten at once. Past models are kept (ModelMemory). When one of them fits again, it becomes
/// the champion: the vehicle is back. With `adapt = none` there is the champion alone.
///
/// Real time: as OnlineSvr. While a challenger is tried an update costs about twice as much, and
/// each of the two has the budget for itself. Taking up a past model takes as long as restate(),
/// whatever the budget. Memory: bytes(), that of two OnlineSvr and of the past models.
class AdaptiveSvr final : public OnlineRegressor {
 public:
  /// A sample is `inputs` scaled inputs followed by `terms` scaled physics terms. Throws InputError
  /// on settings that don't validate.
  AdaptiveSvr(std::size_t inputs, const OnlineSvrSettings& settings, std::size_t terms = 0);

  /// What every update from now on may spend; a default one never ends.
  void limit(const Budget& budget);

  Decision update(std::span<const double> z, double y, double t) noexcept override;
  /// The past models are tried at once, and a challenger needs less evidence.
  void alert(double since_s, bool another) noexcept override {
    memory_.alert(since_s, another);
    detector_.expect();
  }
  double predict(std::span<const double> z) const noexcept override;
  Status status() const override;

  /// KernelDensity::novelty() of a sample's inputs among the champion's buffer. Cost: two kernel
  /// rows.
  double novelty(std::span<const double> z) const { return champion().buffer().novelty(z); }

  /// Goes over to another scale, as OnlineSvr::restate().
  void restate(const SampleMap& map);

  /// core/archive.hpp. The challenger is part of the state only while it is tried.
  void visit(Archive& archive);

  /// Adds a past model from elsewhere to the memory; its samples are learned with these settings.
  /// False when there is no room. Requires one made for such a buffer, and that nothing has been
  /// learned yet. Cost as restate().
  bool add_past(const PastModel& past);

  /// The champion goes on with the samples of a past model: OnlineSvr::take_up().
  void take_up(const PastModel& past, double now) {
    champion().take_up(past, now);
    misfit_.clear();
  }

  const ModelMemory& memory() const { return memory_; }

  const OnlineSvr& champion() const { return learners_[champion_]; }
  const OnlineSvrSettings& settings() const { return champion().settings(); }
  const SvrFunction& model() const { return champion().model(); }

  /// All memory of a learner in bytes, known before there is one. Requires settings that validate.
  static std::size_t bytes(std::size_t inputs, const OnlineSvrSettings& settings,
                           std::size_t terms = 0);

 private:
  static constexpr std::size_t kLeastMisfits = 50;  ///< before they tell anything

  OnlineSvr& champion() { return learners_[champion_]; }
  OnlineSvr& challenger() { return learners_[1 - champion_]; }
  static double lasting_error(const OnlineSvr& learner, std::span<const double> z, double y);
  bool teach_challenger(std::span<const double> z, double y, double t);
  void look_back();
  double usual_misfit() const;
  void judge(Decision& decision, double error, std::optional<double> other, double t);
  void remember(Decision& decision, double t);
  void learn_anew(PastModel& past);
  void succeed(Decision& decision, double since);
  void take_over(Decision& decision);

  std::vector<OnlineSvr> learners_;  ///< one, or two with adapt = challenger
  std::size_t champion_ = 0;
  ChangeDetector detector_;
  ModelMemory memory_;
  RobustScale misfit_{kLeastMisfits, 16};  ///< of the champion's lasting part in its own buffer
  std::vector<double> sample_;             ///< scratch
  Tally tally_;                            ///< over all champions
};

}  // namespace kelpie
