// SPDX-License-Identifier: Apache-2.0
#include "study/identification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "core/text.hpp"
#include "identify/pose_fit.hpp"
#include "kelpie/alignment/alignment.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/settings.hpp"
#include "log/known_roles.hpp"
#include "log/plausibility.hpp"
#include "motion/signal_names.hpp"
#include "motion/states.hpp"
#include "study/metrics.hpp"
#include "study/tuning.hpp"

namespace kelpie::study {
namespace {

constexpr std::array<std::size_t, kPlanarAxes> kAxes{0, 1, 5};  // of velocity_axis()
constexpr std::array<const char*, kPlanarAxes> kAxisNames{"surge", "sway", "yaw rate"};

std::vector<std::size_t> find_thrusters(const log::Dataset& data,
                                        const std::vector<std::size_t>& velocities,
                                        const std::vector<std::string>& wanted) {
  std::vector<std::size_t> thrusters;
  for (const std::string& name : wanted) {
    thrusters.push_back(data.require_input_of("--thrusters", name));
  }
  if (!wanted.empty()) {
    return thrusters;
  }
  for (std::size_t i = 0; i < data.input_names.size(); ++i) {
    const std::string& name = data.input_names[i];
    if (std::ranges::find(velocities, i) != velocities.end() || velocity_axis(name)) {
      continue;
    }
    if (log::names_fin(name)) {
      throw InputError({.file = data.source, .line = 0, .field = name},
                       "is a fin by its name, and the forces of fins are not in the equation "
                       "(docs/howto/identify.md, \"Where it fails\"); say by --thrusters which "
                       "inputs are thrusters (a fin then takes no part)");
    }
    if (!names_thruster(name)) {
      throw InputError({.file = data.source, .line = 0, .field = name},
                       "has no name of a thruster's speed; say by --thrusters which inputs are "
                       "(what isn't one then takes no part)");
    }
    thrusters.push_back(i);
  }
  if (thrusters.empty()) {
    throw InputError({.file = data.source, .line = 0, .field = {}},
                     "no input is a thruster's speed: nothing drives the vehicle");
  }
  return thrusters;
}

// A log of commands that go with no force (pulses far from 0, a vehicle at rest) has an estimate
// that is no number.
void require_numbers(const log::Dataset& data, const PlanarFit& fit) {
  for (const FittedParameter& parameter : fit.parameters) {
    if (parameter.state != ParameterState::not_told &&
        !(std::isfinite(parameter.value) && std::isfinite(parameter.error))) {
      throw InputError({.file = data.source, .line = 0, .field = parameter.name},
                       "is not told by the log: the fit has no finite value for the parameter; the "
                       "inputs of thrusters have to be speeds that are 0 at rest (pulses rest at "
                       "1500 µs: [log.actuators] neutral), and every thruster has to run");
    }
  }
}

// What is known of the mistake; else how columns are converted.
std::string remedy_for(const log::Dataset& data, const std::string& velocity) {
  for (const log::Mistake& mistake : log::target_mistakes(data, SharedSettings().states)) {
    if (mistake.is_refused) {
      return log::mistake_text(mistake);
    }
  }
  return fmt::format("--units converts a column to the SI, as in --units {}=deg/s or --units t=ms",
                     velocity);
}

void require_accelerations(const log::Dataset& data, const PlanarColumns& columns,
                           const PlanarRows& rows, const std::vector<std::size_t>& picked) {
  std::vector<double> accelerations;
  for (const std::size_t row : picked) {
    for (const std::size_t target : columns.targets) {
      accelerations.push_back(data.target(row)[target]);
    }
  }
  const auto checks = of_log(data, [&] { return check_accelerations(rows, accelerations); });
  for (std::size_t axis = 0; axis < kPlanarAxes; ++axis) {
    const auto [correlation, slope] = checks[axis];
    if (correlation < kTuning.identification.least_correlation ||
        slope < kTuning.identification.least_slope || slope > kTuning.identification.most_slope) {
      const std::string& velocity = data.input_names[columns.velocities[axis]];
      throw InputError(
          {.file = data.source, .line = 0, .field = data.target_names[columns.targets[axis]]},
          fmt::format("isn't the acceleration of '{0}' [unit of {0}/s]: over windows of 5 s the "
                      "correlation with the slope of '{0}' is {1:.2f}, the size {2:.2f} times as "
                      "large; {3}",
                      velocity, correlation, slope, remedy_for(data, velocity)));
    }
  }
}

HeldOutFit judge(const log::Dataset& data, const std::vector<std::size_t>& rows,
                 const PlanarColumns& columns, const PlanarFit& fit) {
  HeldOutFit held_out(kPlanarAxes);
  const PlanarRows planar = planar_rows(data, rows, columns);
  const PlanarVehicle vehicle = fit.vehicle();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    held_out.times_s.push_back(planar.times_s[i]);
    const PlanarVector tied = vehicle.acceleration(planar.velocity(i), planar.speed(i));
    const PlanarVector untied = fit.free_acceleration(planar.velocity(i), planar.speed(i));
    for (std::size_t axis = 0; axis < kPlanarAxes; ++axis) {
      held_out.measured[axis].push_back(data.target(rows[i])[columns.targets[axis]]);
      held_out.structure[axis].push_back(tied[axis]);
      held_out.free[axis].push_back(untied[axis]);
    }
  }
  held_out.score();
  return held_out;
}

// The poses of rows that are given as stretches, and the thrusters' speeds then.
PoseRows pose_rows(const log::Dataset& data, const std::vector<std::size_t>& rows,
                   const PlanarColumns& columns, const PlanarRows& stretches) {
  PoseRows found{.thrusters = stretches.thrusters,
                 .times_s = stretches.times_s,
                 .poses = {},
                 .speeds = {},
                 .starts = stretches.starts};
  for (const std::size_t row : rows) {
    const std::span pose = std::span(data.poses).subspan(kPlanarAxes * row, kPlanarAxes);
    found.poses.insert(found.poses.end(), pose.begin(), pose.end());
    for (const std::size_t thruster : columns.thrusters) {
      found.speeds.push_back(data.pose_inputs[row * data.input_names.size() + thruster]);
    }
  }
  return found;
}

// Works on the fit of either kind.
template <typename Fit>
void give_scale_to(const KnownThrust& known, Fit& fit, ScaleSource& scale) {
  if (!known.thrust.empty()) {
    scale_by_thrust(fit, known.thrust);
    scale = ScaleSource::thrust;
  } else if (known.mass_kg) {
    const double mass = *known.mass_kg;
    if (known.surge_added_mass_kg) {
      scale = known.is_of_vehicle_file ? ScaleSource::vehicle_file : ScaleSource::inertia;
      scale_by_inertia(fit, mass + *known.surge_added_mass_kg, 0.0);
    } else {
      scale = ScaleSource::assumed_added_mass;
      scale_by_inertia(fit, mass * (1.0 + kTuning.identification.added_share),
                       mass * kTuning.identification.added_error);
    }
  }
}

}  // namespace

PlanarColumns planar_columns(const log::Dataset& data, const std::string& states,
                             const std::vector<std::string>& wanted) {
  const std::vector<std::size_t> found =
      find_states(states, data.input_names, data.target_names.size());
  PlanarColumns columns;
  const bool named = std::ranges::any_of(
      found, [&](std::size_t input) { return velocity_axis(data.input_names[input]).has_value(); });
  for (std::size_t axis = 0; axis < kPlanarAxes; ++axis) {
    const auto has_axis = [&](std::size_t input) {
      return velocity_axis(data.input_names[input]) == kAxes[axis];
    };
    const auto place = named || found.size() != kPlanarAxes
                           ? std::ranges::find_if(found, has_axis)
                           : found.begin() + static_cast<std::ptrdiff_t>(axis);
    if (place == found.end()) {
      throw InputError({.file = data.source, .line = 0, .field = {}},
                       fmt::format("no input with a target is the velocity of {}; name them by "
                                   "--set states=SURGE,SWAY,YAW, in the order of the targets "
                                   "(inputs: {}; targets: {})",
                                   kAxisNames[axis], join_text(data.input_names, ", "),
                                   join_text(data.target_names, ", ")));
    }
    columns.velocities[axis] = *place;
    columns.targets[axis] = static_cast<std::size_t>(place - found.begin());
  }
  columns.thrusters = find_thrusters(data, found, wanted);
  return columns;
}

void add_row(PlanarRows& rows, std::span<const double> inputs, double t,
             const PlanarColumns& columns, bool follows) {
  if (!follows) {
    rows.starts.push_back(rows.rows());
  }
  rows.times_s.push_back(t);
  for (const std::size_t velocity : columns.velocities) {
    rows.velocities.push_back(inputs[velocity]);
  }
  for (const std::size_t thruster : columns.thrusters) {
    rows.speeds.push_back(inputs[thruster]);
  }
}

PlanarRows planar_rows(const log::Dataset& data, const std::vector<std::size_t>& rows,
                       const PlanarColumns& columns) {
  PlanarRows planar;
  planar.starts.clear();
  for (const std::size_t thruster : columns.thrusters) {
    planar.thrusters.push_back(data.input_names[thruster]);
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t row = rows[i];
    add_row(planar, data.input(row), data.times_s[row], columns,
            i > 0 && log::follows(data, rows[i - 1], row));
  }
  return planar;
}

HeldOutFit::HeldOutFit(std::size_t axes)
    : measured(axes), structure(axes), free(axes), r2(axes), free_r2(axes) {}

void HeldOutFit::score() {
  for (std::size_t axis = 0; axis < measured.size(); ++axis) {
    r2[axis] = r_squared(measured[axis], structure[axis]);
    free_r2[axis] = r_squared(measured[axis], free[axis]);
  }
}

std::vector<std::string> fins_of(const log::Dataset& data) {
  std::vector<std::string> fins;
  std::ranges::copy_if(data.input_names, std::back_inserter(fins), log::names_fin);
  return fins;
}

std::string fins_text(const std::vector<std::string>& fins) {
  return fins.empty()
             ? ""
             : join_text(fins, ", ") +
                   (fins.size() == 1 ? " is a fin by its name" : " are fins by their names") +
                   ": forces of fins go with the square of the speed, and are not in the equation "
                   "(docs/howto/identify.md, \"Where it fails\")";
}

Identification identification_of(const log::Dataset& data, const Split& split,
                                 std::size_t training_rows, std::span<const std::size_t> targets,
                                 std::span<const double> commands, std::size_t thrusters) {
  Identification found;
  found.source = data.source;
  found.split = split.label;
  found.training_rows = training_rows;
  found.fins = fins_of(data);
  for (const std::size_t target : targets) {
    found.targets.push_back(data.target_names[target]);
  }
  found.greatest_speeds.assign(thrusters, 0.0);
  for (std::size_t i = 0; i < commands.size(); ++i) {
    double& greatest = found.greatest_speeds[i % thrusters];
    greatest = std::max(greatest, std::abs(commands[i]));
  }
  return found;
}

void give_scale(const KnownThrust& known, Identification& found) {
  found.mass_kg = known.mass_kg;
  if (found.six) {
    give_scale_to(known, *found.six, found.scale);
  } else {
    give_scale_to(known, found.planar, found.scale);
  }
}

Identification identify(const log::Dataset& data, const Split& split, const PlanarColumns& columns,
                        const KnownThrust& known, std::optional<int> only, bool accepts) {
  const std::vector<std::size_t> training = training_rows(data, split, only);
  const int wanted = data.configurations[training.front()];
  const PlanarRows rows = planar_rows(data, training, columns);
  Identification found = identification_of(data, split, training.size(), columns.targets,
                                           rows.speeds, columns.thrusters.size());
  if (data.poses.empty()) {
    if (!accepts) {
      require_accelerations(data, columns, rows, training);
    }
    found.planar = of_log(data, [&] { return fit_planar(rows); });
  } else {
    const PoseRows poses = pose_rows(data, training, columns, rows);
    found.planar = of_log(data, [&] { return fit_poses(poses); });
    found.of_poses = true;
  }
  require_numbers(data, found.planar);
  if (data.poses.empty()) {  // else held-out accelerations are those of noise, above all
    found.held_out =
        judge(data, of_configuration(data, split.held_out, wanted), columns, found.planar);
  }
  give_scale(known, found);
  for (const std::string& thruster : rows.thrusters) {
    const auto unit = data.units.find(thruster);
    found.speed_units.push_back(unit == data.units.end() ? "" : unit->second.text());
  }
  return found;
}

}  // namespace kelpie::study
