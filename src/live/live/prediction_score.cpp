// SPDX-License-Identifier: Apache-2.0
#include "live/prediction_score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/quantile.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "live/tuning.hpp"
#include "study/baselines.hpp"
#include "study/diagnosis.hpp"
#include "study/metrics.hpp"

namespace kelpie::live {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// R² of one predictor, over the samples with a prediction of it.
template <typename Scored, typename Predicted>
double r2_of(const std::vector<Scored>& samples, Predicted predicted) {
  std::vector<double> truth;
  std::vector<double> scored;
  for (const Scored& sample : samples) {
    if (std::isfinite(predicted(sample))) {
      truth.push_back(sample.truth);
      scored.push_back(predicted(sample));
    }
  }
  return study::r_squared(truth, scored);
}

}  // namespace

PredictionScore::PredictionScore(const StreamPlan& plan)
    : inputs_(plan.inputs),
      names_(plan.targets),
      scored_(plan.targets.size(), Recent<Scored>(kTuning.scored_samples)),
      delays_ms_(kTuning.timed_rows) {
  log::Dataset names;
  names.input_names = plan.inputs;
  names.target_names = plan.targets;
  simple_ = {study::make_least_squares(names), study::make_mean(names),
             study::make_last_value(names)};
}

void PredictionScore::score(std::span<const double> x, std::span<const double> y, double t,
                            std::span<const Decision> decisions) {
  for (const std::unique_ptr<OnlineModel>& simple : simple_) {
    if (simple) {
      simple->update(x, y, t);
    }
  }
  for (std::size_t i = 0; i < y.size(); ++i) {
    const Decision& decision = decisions[i];
    if (!decision.had_model) {
      continue;
    }
    Scored scored{
        .truth = y[i],
        .predicted = decision.prediction.value,
        .is_inside = decision.prediction.lower <= y[i] && y[i] <= decision.prediction.upper};
    std::ranges::transform(simple_, scored.simple.begin(), [&](const auto& simple) {
      return simple && simple->decisions()[i].had_model ? simple->decisions()[i].prediction.value
                                                        : kNone;
    });
    scored_[i].add(scored);
  }
}

void PredictionScore::add_delay(std::chrono::nanoseconds delay) {
  delays_ms_.add(std::chrono::duration<double, std::milli>(delay).count());
}

void PredictionScore::report(const DynamicsModel& model, LearnerHealth& health) const {
  health.axes.clear();
  for (std::size_t i = 0; i < model.axes(); ++i) {
    const std::vector<Scored>& scored = scored_[i].values();
    const auto simple = [&](std::size_t which) {
      return r2_of(scored, [&](const Scored& sample) { return sample.simple[which]; });
    };
    AxisHealth& axis = health.axes.emplace_back();
    axis.name = names_[i];
    axis.status = model.axis(i).status();
    axis.judged = scored.size();
    axis.r2 = r2_of(scored, [](const Scored& sample) { return sample.predicted; });
    axis.r2_least_squares = simple(0);
    axis.r2_mean = simple(1);
    axis.r2_last_value = simple(2);
    if (!scored.empty()) {
      axis.coverage = static_cast<double>(std::ranges::count(scored, true, &Scored::is_inside)) /
                      static_cast<double>(scored.size());
    }
    axis.disturbance = model.decisions()[i].prediction.disturbance;
    if (axis.status.ready) {
      axis.coefficients = model.axis(i).coefficients();
    }
  }
  health.thrusters.clear();
  if (const Diagnosis* const diagnosis = model.diagnosis();
      diagnosis != nullptr && diagnosis->knows_thrust()) {
    for (const Cause& present : diagnosis->present()) {
      const Cause cause =
          study::since_the_start(present, diagnosis->health(), diagnosis->findings()).cause;
      health.thrusters.push_back({.name = inputs_[cause.place],
                                  .share = cause.size,
                                  .lower = cause.lower,
                                  .upper = cause.upper});
    }
  }
  std::vector<double> delays_ms = delays_ms_.values();
  if (!delays_ms.empty()) {
    health.median_delay_ms = quantile(delays_ms, 0.5);
    health.longest_delay_ms = std::ranges::max(delays_ms);
  }
}

}  // namespace kelpie::live
