// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/open_loop.hpp"

#include <memory>
#include <string>

#include "kelpie/core/error.hpp"
#include "kelpie/model/trained_model.hpp"
#include "model/snapshot.hpp"
#include "motion/states.hpp"

namespace kelpie {
namespace {

// What the accelerations need, shared by all copies of the function.
struct Blend {
  TrainedModel model;
  TermSet terms;
  OpenLoopPart part;

  void operator()(std::span<const double> x, std::span<double> a) const {
    ShortVector<kMostTerms> phi(terms.size());
    if (part != OpenLoopPart::learned) {
      terms.evaluate(x, phi);
    }
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double share = share_of(model.axes[i].steady);
      a[i] = share < 1.0 ? (1.0 - share) * model.axes[i].predict(model.terms, x) : 0.0;
      if (share > 0.0) {
        a[i] += share * model.axes[i].steady.acceleration(as_span(phi));
      }
    }
  }

  double share_of(const SteadyModel& steady) const {
    return part == OpenLoopPart::both ? steady.share : part == OpenLoopPart::steady ? 1.0 : 0.0;
  }
};

std::string reason_against(const TrainedModel& model) {
  const bool knows_velocities =
      !find_states(model.settings.shared.states, model.input_names, model.axes.size()).empty();
  return knows_velocities
             ? "the model learned too little so far, or in an earlier version of kelpie "
               "with other equations of motion; learn the log again"
             : "the model doesn't know which input is its velocity (setting 'states')";
}

}  // namespace

OpenLoop open_loop(const TrainedModel& model, OpenLoopPart part) {
  OpenLoop loop;
  for (const TrainedModel::Axis& axis : model.axes) {
    const SteadyModel& steady = axis.steady;
    if (!steady.ready()) {
      throw InputError(axis.name, "cannot be rolled out: " + reason_against(model));
    }
    loop.states.push_back(steady.state);
    loop.axes.push_back(velocity_axis(model.input_names[steady.state]));
    loop.error.push_back(steady.error);
    loop.error_time_s.push_back(steady.error_time_s);
    loop.noise.push_back(steady.noise);
    loop.off.push_back(steady.off);
    loop.kept.push_back(steady.kept);
  }
  loop.seen = model.axes.front().steady.seen;
  const Attitude attitude = attitude_for(model.settings.shared.terms, model.input_names);
  loop.attitude = AttitudeMotion(attitude, model.input_names, loop.states);
  const auto blend = std::make_shared<const Blend>(
      Blend{model, TermSet::open_loop(model.input_names, loop.states, attitude), part});
  loop.accelerations = [blend](std::span<const double> x, std::span<double> a) { (*blend)(x, a); };
  return loop;
}

}  // namespace kelpie
