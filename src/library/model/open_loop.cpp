// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/open_loop.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "kelpie/core/error.hpp"
#include "kelpie/model/trained_model.hpp"
#include "model/snapshot.hpp"
#include "model/tuning.hpp"

namespace kelpie {
namespace {

constexpr const auto& kOpenLoop = kModelTuning.rollout;

// What the accelerations need, shared by all copies of the function.
class Blend {
 public:
  Blend(TrainedModel model, TermSet terms, double fade_s)
      : model_(std::move(model)), terms_(std::move(terms)), fade_s_(fade_s) {}

  void operator()(std::span<const double> x, double age_s, std::span<double> a) const {
    const double share = std::exp(-age_s / fade_s_);
    if (share < kOpenLoop.least_share) {
      blend(x, 0.0, a);
    } else {
      model_.predict(x, a);
      blend(x, share, a);
    }
  }

 private:
  void blend(std::span<const double> x, double share, std::span<double> a) const {
    ShortVector<kMostTerms> phi(terms_.size());
    terms_.evaluate(x, phi);
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double steady = model_.axes[i].steady.acceleration(as_span(phi));
      a[i] = share == 0.0 ? steady : share * a[i] + (1.0 - share) * steady;
    }
  }

  TrainedModel model_;
  TermSet terms_;
  double fade_s_;
};

// In files of older versions a steady part has fewer terms.
TermSet steady_terms(const TrainedModel& model, std::span<const std::size_t> states) {
  const TermSet terms = TermSet::open_loop(model.input_names, states);
  return model.axes.front().steady.weights.size() == terms.size() + 1
             ? terms
             : TermSet::manoeuvring(model.input_names, states);
}

}  // namespace

OpenLoop open_loop(const TrainedModel& model, double fade_s) {
  if (!(fade_s > 0.0)) {
    throw InputError("fade", "has to be > 0 s");
  }
  OpenLoop loop;
  for (const TrainedModel::Axis& axis : model.axes) {
    if (!axis.steady.ready()) {
      throw InputError(axis.name,
                       "cannot be rolled out: the model doesn't know which input is its velocity "
                       "(setting 'states'), or learned from fewer than " +
                           std::to_string(kModelTuning.steady.least_steps) + " steps");
    }
    loop.states.push_back(axis.steady.state);
    const bool learned_is_worse = axis.steady.learned_error > axis.steady.error;
    loop.error.push_back(std::max(axis.steady.error, axis.steady.learned_error));
    loop.error_time_s.push_back(learned_is_worse ? std::min(fade_s, kOpenLoop.longest_error_s)
                                                 : axis.steady.error_time_s);
    loop.noise.push_back(axis.steady.noise);
  }
  loop.seen = model.axes.front().steady.seen;
  const auto blend = std::make_shared<const Blend>(model, steady_terms(model, loop.states), fade_s);
  loop.accelerations = [blend](std::span<const double> x, double age_s, std::span<double> a) {
    (*blend)(x, age_s, a);
  };
  return loop;
}

}  // namespace kelpie
