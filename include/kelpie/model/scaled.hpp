// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kelpie/core/scaling.hpp"
#include "kelpie/model/remembered_model.hpp"
#include "kelpie/model/settings.hpp"
#include "kelpie/online/regressor.hpp"
#include "kelpie/online/sample_collector.hpp"
#include "kelpie/online/valid_sample.hpp"
#include "kelpie/physics/term_set.hpp"

namespace kelpie {

/// Puts raw inputs and targets in front of a learner that wants them scaled, with the physics terms
/// (TermSet) behind the inputs. Where the scaling is
/// not given, it is taken from the first samples: these are held back, and learned all at once when
/// there are `warmup` of them and their covariance can be inverted. (A thruster that has not moved
/// yet makes it wait; then the scaling is that of all samples seen, and the last `warmup` of them
/// are learned.) From then on it stays fixed, or with `track` it is taken anew from all samples so
/// far whenever these have left it by that ratio: the learner's samples are put into the new scale
/// and it solves anew. It happens a few times in a life, since all samples weigh alike. Decisions
/// and predictions are in raw units, but for the KKT gap. Allocates in the constructor, and once
/// more when the scaling is found.
template <typename Learner>
class Scaled final : public OnlineRegressor {
 public:
  /// The scaling comes from the first samples. Requires inputs <= kMostInputs.
  Scaled(std::size_t inputs, const SharedSettings& settings, Learner learner, TermSet terms = {})
      : inputs_(inputs),
        settings_(settings),
        learner_(std::move(learner)),
        terms_(std::move(terms)),
        moments_(inputs),
        target_moments_(1),
        term_moments_(terms_.size()),
        term_values_(terms_.size()) {
    held_.reserve(static_cast<std::size_t>(settings.warmup));
  }

  /// The scaling is given.
  Scaled(AxisScaling scaling, Learner learner, TermSet terms = {})
      : inputs_(scaling.input.dimension()),
        learner_(std::move(learner)),
        terms_(std::move(terms)),
        moments_(0),
        target_moments_(0),
        term_moments_(0),
        scaling_(std::move(scaling)) {}

  Decision update(std::span<const double> x, double y, double t) override {
    if (!valid_sample(x, inputs_, y, t)) {
      ++invalid_;
      return {.verdict = Verdict::invalid, .kkt_gap = learner_.status().kkt_gap};
    }
    if (!scaling_) {
      return hold(x, y, t);
    }
    follow(x, y);
    return learn(*scaling_, x, y, t);
  }

  void alert(double since_s, bool another) override { learner_.alert(since_s, another); }

  /// Before there is a model: the mean of the targets so far (0 at the very start).
  double predict(std::span<const double> x) const override {
    return scaling_ ? scaling_->target.invert(
                          learner_.predict(as_span(scale_sample(*scaling_, terms_, x))))
                    : mean_so_far();
  }

  /// Everything is new before there is a scale. No interval: that is DynamicsAxis' business.
  Prediction assess(std::span<const double> x) const override {
    Prediction prediction{.value = predict(x)};
    if constexpr (requires(std::span<const double> z) { learner_.novelty(z); }) {
      prediction.novelty =
          scaling_ ? learner_.novelty(as_span(scale_sample(*scaling_, terms_, x))) : 1.0;
    }
    return prediction;
  }

  Status status() const override {
    Status status = learner_.status();
    status.tally.invalid += invalid_;
    return status;
  }

  std::vector<Coefficient> coefficients() const override {
    std::vector<Coefficient> list;
    if constexpr (requires { learner_.model().term_weights(); }) {
      for (std::size_t k = 0; scaling_ && k < terms_.size(); ++k) {
        const double weight = learner_.model().term_weights()[k];
        list.push_back({terms_.text(k), scaling_->target.scale * weight / scaling_->term_scale[k]});
      }
    }
    return list;
  }

  void visit(Archive& archive) {  ///< core/archive.hpp
    const bool given = moments_.dimension() != inputs_;
    archive.same("scales", given ? "given" : "from the first samples");
    archive.part("learner", learner_);
    archive.part("moments", moments_);
    archive.part("target_moments", target_moments_);
    archive.part("term_moments", term_moments_);
    archive.whole(invalid_);
    visit_held(archive);
    bool found = scaling_.has_value();
    archive.flag(found);
    archive.require(!given || (found && moments_.count() == 0), "lacks the scaling it was given");
    if (archive.loading() && found) {
      scaling_.emplace();
      awaited_.clear();  // they are among the learner's
    }
    if (scaling_) {
      archive.part("scaling", *scaling_, inputs_, terms_.size());
    }
  }

  /// The past models that the learner keeps, in the units of the log. Allocates.
  std::vector<RememberedModel> remembered() const {
    std::vector<RememberedModel> list = awaited_;
    if constexpr (requires { learner_.memory(); }) {
      if (scaling_) {
        for (const PastModel& past : learner_.memory().models()) {
          list.push_back(in_log_units(past, *scaling_));
        }
      }
    }
    return list;
  }

  /// Gives the learner past models to keep, as soon as the scale is known. Requires that nothing
  /// has been learned yet, room for them, and as many inputs. Allocates.
  void remember(std::vector<RememberedModel> models) {
    awaited_ = std::move(models);
    if (scaling_) {
      add_awaited(*scaling_);
    }
  }

  /// Nothing while samples are held back.
  const std::optional<AxisScaling>& scaling() const { return scaling_; }
  const TermSet& terms() const { return terms_; }
  const Learner& learner() const { return learner_; }

 private:
  static constexpr std::size_t kLookEvery = 64;  ///< samples between two looks at the drift

  struct Held {
    std::vector<double> x;
    double y;
    double t;
  };

  void visit_held(Archive& archive) {
    archive.list(
        held_, static_cast<std::size_t>(settings_.warmup),
        [&](Held& sample) {
          if (archive.loading()) {
            sample.x.resize(inputs_);
          }
          archive.numbers(sample.x);
          archive.number(sample.y);
          archive.number(sample.t);
        },
        (inputs_ + 2) * sizeof(double));
  }

  void add_awaited(const AxisScaling& scaling) {
    if constexpr (requires { learner_.memory(); }) {
      for (const RememberedModel& model : awaited_) {
        learner_.add_past(
            in_learner_units(model, scaling, terms_, std::as_const(learner_).champion()));
      }
    }
    awaited_.clear();
  }

  double mean_so_far() const { return target_moments_.count() > 0 ? target_moments_.mean()[0] : 0; }

  Decision learn(const AxisScaling& scaling, std::span<const double> x, double y, double t) {
    Decision decision =
        learner_.update(as_span(scale_sample(scaling, terms_, x)), scaling.target.apply(y), t);
    decision.predicted = scaling.target.invert(decision.predicted);
    return decision;
  }

  Decision hold(std::span<const double> x, double y, double t) {
    Decision decision{.verdict = Verdict::held_back, .predicted = mean_so_far()};
    count(x, y);
    const auto most = static_cast<std::size_t>(settings_.warmup);
    if (held_.size() == most) {
      held_.erase(held_.begin());
    }
    held_.push_back({{x.begin(), x.end()}, y, t});
    if (held_.size() == most) {
      scaling_ = scaling_so_far();
    }
    if (scaling_) {
      add_awaited(*scaling_);
      for (const Held& sample : held_) {
        const Decision step = learn(*scaling_, sample.x, sample.y, sample.t);
        decision.iterations += step.iterations;
        decision.kkt_gap = step.kkt_gap;
        decision.served = step.served;
      }
      held_ = {};
    }
    return decision;
  }

  void count(std::span<const double> x, double y) {
    moments_.add(x);
    target_moments_.add({&y, 1});
    terms_.evaluate(x, term_values_);
    term_moments_.add(term_values_);
  }

  // Nothing while the samples seen don't determine it.
  std::optional<AxisScaling> scaling_so_far() const {
    const double variance = target_moments_.covariance()(0, 0);
    auto input = InputScaling::from(moments_, settings_.scaling);
    if (!input || !(variance > 0.0)) {
      return std::nullopt;
    }
    return AxisScaling{*std::move(input),
                       {mean_so_far(), std::sqrt(variance)},
                       terms_.scales(moments_, term_moments_)};
  }

  // A scaling that was given is not followed: there are no moments from its beginning.
  void follow(std::span<const double> x, double y) {
    if constexpr (requires { learner_.restate(SampleMap{}); }) {
      if (settings_.track == 0.0 || moments_.count() == 0) {
        return;
      }
      count(x, y);
      // NOLINTBEGIN(bugprone-unchecked-optional-access): who calls has looked
      const double ratio = std::sqrt(target_moments_.covariance()(0, 0)) / scaling_->target.scale;
      if (moments_.count() % kLookEvery == 0 &&
          std::max({scaling_->input.drift(moments_), ratio, 1.0 / ratio}) > settings_.track) {
        // NOLINTEND(bugprone-unchecked-optional-access)
        if (std::optional<AxisScaling> found = scaling_so_far()) {
          learner_.restate(map_to(*found));
          scaling_ = *std::move(found);
        }
      }
    }
  }

  // From the scale in use to another one.
  SampleMap map_to(const AxisScaling& next) const {
    return [this, &next](std::span<double> x, double& y) {
      const AxisScaling& now = *scaling_;
      const ScaledInput raw = now.input.invert(x.first(inputs_));
      std::ranges::copy(as_span(next.input.apply(as_span(raw))), x.begin());
      for (std::size_t k = 0; k < terms_.size(); ++k) {
        x[inputs_ + k] *= now.term_scale[k] / next.term_scale[k];
      }
      y = next.target.apply(now.target.invert(y));
    };
  }

  std::size_t inputs_;
  SharedSettings settings_;
  Learner learner_;
  TermSet terms_;
  Moments moments_;
  Moments target_moments_;
  Moments term_moments_;
  std::vector<double> term_values_;
  std::vector<RememberedModel> awaited_;  ///< what the learner is to keep once there is a scale
  std::vector<Held> held_;  ///< the last `warmup` samples while the scaling is not known
  std::int64_t invalid_ = 0;
  std::optional<AxisScaling> scaling_;
};

}  // namespace kelpie
