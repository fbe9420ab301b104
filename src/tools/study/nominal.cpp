// SPDX-License-Identifier: Apache-2.0
#include "study/nominal.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>

#include "core/eigen.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "learner/triangular_fit.hpp"
#include "model/snapshot.hpp"
#include "motion/states.hpp"
#include "simulator/decomposition.hpp"
#include "simulator/dynamics.hpp"
#include "study/six_axes.hpp"
#include "study/tuning.hpp"
#include "svr/function_mix.hpp"

namespace kelpie::study {
namespace {

constexpr const char* kConstant = "1";
constexpr double kNoPrior = 1e-12;  // the vehicle's equation has no noise

// The body axis of each target's velocity; none for a target of another kind.
std::vector<std::optional<std::size_t>> axes_of_targets(const log::Dataset& data,
                                                        const std::string& states) {
  std::vector<std::optional<std::size_t>> axes(data.target_names.size());
  const std::vector<std::size_t> inputs =
      find_states(states, data.input_names, data.target_names.size());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    axes[i] = velocity_axis(data.input_names[inputs[i]]);
  }
  return axes;
}

// The accelerations of a vehicle file on the inputs of a log.
class VehicleOnInputs {
 public:
  VehicleOnInputs(const simulator::VehicleParameters& vehicle, const log::Dataset& data,
                  Frame frame, double neutral)
      : vehicle_(vehicle),
        dynamics_(simulator::make_plant(vehicle, simulator::Configuration{})),
        attitude_(find_attitude(data.input_names)),
        frame_(frame),
        neutral_(neutral) {
    for (const std::string& name : data.input_names) {
      axes_.push_back(velocity_axis(name));
    }
    std::vector<std::string> names;
    for (const simulator::Thruster& thruster : vehicle.thrusters) {
      names.push_back(thruster.name);
      inputs_.push_back(data.find_input(thruster.name));
    }
    require(std::ranges::any_of(inputs_, &std::optional<std::size_t>::has_value), "--nominal",
            "the vehicle's thrusters are " + join_text(names, ", ") +
                "; none is among the inputs " + join_text(data.input_names, ", "));
  }

  const Attitude& attitude() const { return attitude_; }

  // By body axis, in the frame of the log.
  simulator::Vector6 acceleration(std::span<const double> x) const {
    simulator::Vector6 velocity = simulator::Vector6::Zero();
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (axes_[i]) {
        velocity(static_cast<Eigen::Index>(*axes_[i])) = sign_in_frd(frame_, *axes_[i]) * x[i];
      }
    }
    const auto [forward, right, down] = down_of(attitude_, x, frame_);
    const Eigen::Quaterniond attitude = simulator::attitude_of({forward, right, down});
    simulator::Vector6 result = dynamics_.acceleration(attitude, velocity, rotor_speeds(x));
    for (Eigen::Index axis = 0; axis < result.size(); ++axis) {
      result(axis) *= sign_in_frd(frame_, static_cast<std::size_t>(axis));
    }
    return result;
  }

 private:
  simulator::RotorSpeeds rotor_speeds(std::span<const double> x) const {
    simulator::RotorSpeeds speeds =
        simulator::RotorSpeeds::Zero(static_cast<Eigen::Index>(inputs_.size()));
    for (std::size_t k = 0; k < inputs_.size(); ++k) {
      if (inputs_[k]) {
        const simulator::Thruster& thruster = vehicle_.thrusters[k];
        const double command =
            thruster.max_speed_rps * command_share(vehicle_, k, x[*inputs_[k]], neutral_);
        speeds(static_cast<Eigen::Index>(k)) = simulator::speed_for_command(thruster, command);
      }
    }
    return speeds;
  }

  const simulator::VehicleParameters& vehicle_;
  simulator::Dynamics dynamics_;
  Attitude attitude_;
  Frame frame_;
  double neutral_;
  std::vector<std::optional<std::size_t>> axes_;    // of each input
  std::vector<std::optional<std::size_t>> inputs_;  // of each thruster
};

// The member without a kernel: of models of kelpie 1.x `line`.
const SvrFunction& line_of(const Snapshot& axis, std::string_view option) {
  const auto found =
      std::ranges::find_if(axis.function.members, [](const FunctionMix::Member& member) {
        return member.name == "terms" || member.name == "line";
      });
  require(found != axis.function.members.end(), option,
          "the model has no member 'terms', as a model of learner = svr");
  return found->function;
}

std::vector<Coefficient> coefficients_of(const TrainedModel& model, const Snapshot& axis,
                                         const TermSet& terms, std::string_view option) {
  const SvrFunction& line = line_of(axis, option);
  const AxisScaling& scaling = axis.scaling;
  const std::vector<std::string> known = terms.texts();
  std::vector<Coefficient> list{
      {kConstant, scaling.target.scale * line.bias() + scaling.target.mean}};
  for (std::size_t k = 0; k < model.terms.size(); ++k) {
    if (std::ranges::find(known, model.terms.text(k)) != known.end()) {
      list.push_back(
          {model.terms.text(k), scaling.target.scale *
                                    (line.term_weights()[k] + axis.function.nominal_weight(k)) /
                                    scaling.term_scale[k]});
    }
  }
  return list;
}

}  // namespace

Nominal nominal_of(const TrainedModel& model, std::span<const std::string> targets,
                   const TermSet& terms, std::string_view option) {
  Nominal nominal(targets.size());
  const std::vector<std::string> names = model.target_names();
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const auto found = std::ranges::find(names, targets[i]);
    if (found != names.end()) {
      const auto axis = static_cast<std::size_t>(found - names.begin());
      nominal[i] = coefficients_of(model, model.axes[axis], terms, option);
    }
  }
  require(std::ranges::any_of(nominal, [](const auto& one) { return !one.empty(); }), option,
          "the model has the targets " + join_text(names, ", ") + "; the log has " +
              join_text(targets, ", "));
  return nominal;
}

Nominal nominal_of(const simulator::VehicleParameters& vehicle, const log::Dataset& data,
                   const std::string& states, const TermSet& terms, Frame frame, double neutral) {
  const VehicleOnInputs nominal(vehicle, data, frame, neutral);
  const std::vector<std::optional<std::size_t>> axes = axes_of_targets(data, states);
  TriangularFit fit(terms.size() + 1, kNoPrior, axes.size());
  RandomStream random(1, "nominal");
  std::vector<double> x(data.input_names.size());
  std::vector<double> phi(terms.size() + 1, 1.0);
  std::vector<double> y(axes.size());
  for (int place = 0; place < kTuning.nominal_places; ++place) {
    const std::size_t attitude_row = random.below(data.rows());
    for (std::size_t i = 0; i < x.size(); ++i) {
      const std::size_t row =
          nominal.attitude().contains(i) ? attitude_row : random.below(data.rows());
      x[i] = data.input(row)[i];
    }
    terms.evaluate(x, std::span(phi).first(terms.size()));
    const simulator::Vector6 all = nominal.acceleration(x);
    std::ranges::transform(axes, y.begin(), [&](const std::optional<std::size_t>& axis) {
      return axis ? all(static_cast<Eigen::Index>(*axis)) : 0.0;
    });
    fit.add(phi, y);
  }
  Nominal result(axes.size());
  for (std::size_t i = 0; i < axes.size(); ++i) {
    for (std::size_t k = 0; axes[i] && k <= terms.size(); ++k) {
      result[i].push_back({k < terms.size() ? terms.text(k) : kConstant, fit.theta(i)[k]});
    }
  }
  return result;
}

void give(const Nominal& nominal, DynamicsModel& model) {
  for (std::size_t axis = 0; axis < nominal.size(); ++axis) {
    set_nominal(model, axis, nominal[axis]);
  }
}

Nominal mean_of(std::span<const Nominal> several) {
  Nominal mean(several.front().size());
  for (std::size_t i = 0; i < mean.size(); ++i) {
    std::map<std::string, double> sums;
    double count = 0.0;
    for (const Nominal& one : several) {
      count += one[i].empty() ? 0.0 : 1.0;
      for (const Coefficient& coefficient : one[i]) {
        sums[coefficient.term] += coefficient.value;
      }
    }
    for (const auto& [term, sum] : sums) {
      mean[i].push_back({term, sum / count});
    }
  }
  return mean;
}

}  // namespace kelpie::study
