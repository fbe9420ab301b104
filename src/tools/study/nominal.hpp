// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/motion/frame.hpp"
#include "kelpie/motion/term_set.hpp"
#include "kelpie/svr/regressor.hpp"
#include "log/dataset.hpp"
#include "simulator/parameters.hpp"

namespace kelpie::study {

/// Coefficients of physics terms known before a drive, a list per target of the log, as
/// set_nominal() takes them. An empty list: nothing is known of the target.
using Nominal = std::vector<std::vector<Coefficient>>;

/// Coefficients of the member `line` of an earlier model, of targets with these names. Terms
/// that are not among `terms` are left out, since an input of theirs is missing. Throws InputError
/// (`option`) on a model without this member (`learner = svr`), or without any of the targets.
Nominal nominal_of(const TrainedModel& model, std::span<const std::string> targets,
                   const TermSet& terms, std::string_view option);

/// The terms fitted to the accelerations of a vehicle file at 4,000 places: each velocity and
/// command from a row of the log of its own, the attitude from another. Exact for an equation of
/// motion in these terms. `frame`: of the log's body axes, FLU or FRD. `states`: setting of the
/// model. `neutral`: pulse at rest in the log, 1500, or 0 where it has been subtracted. Thrusters
/// that no input names stand still; states that are no velocity of the body get an empty list.
/// Throws InputError where the log names no thruster of the vehicle.
Nominal nominal_of(const simulator::VehicleParameters& vehicle, const log::Dataset& data,
                   const std::string& states, const TermSet& terms, Frame frame, double neutral);

/// Gives every axis of a new model its coefficients.
void give(const Nominal& nominal, DynamicsModel& model);

/// The mean of several vehicles or drives. A term that only some have counts as 0 in the others; a
/// target that only some have is of those. Requires one or more, of the same targets.
Nominal mean_of(std::span<const Nominal> several);

}  // namespace kelpie::study
