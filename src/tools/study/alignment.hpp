// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "kelpie/alignment/alignment.hpp"
#include "log/dataset.hpp"
#include "study/split.hpp"

namespace kelpie::study {

/// What a log tells of actuators, for a search (AlignmentProblem::known).
std::map<std::string, Actuator> known_actuators(
    const std::map<std::string, log::KnownActuator>& known);

/// The training rows for a search of alignment or current. Refers to `data` and `split`, which have
/// to outlive the problem.
AlignmentProblem alignment_problem(const log::Dataset& data, const Split& split,
                                   const std::string& states);

/// Throws InputError (`field`) unless `wish` is a value of --align: "auto", "none", or seconds
/// within ±Alignment::kMostS. For a check before a log is read.
void check_align(const std::string& wish, const std::string& field);

/// The alignment for an option --align: "auto" searches the training rows (find_alignment), "none",
/// or seconds; actuators known beforehand (Dataset::actuators) hold in each case. `states` is the
/// setting of this name. Throws InputError (`--align`) on other text, on seconds beyond
/// Alignment::kMostS, and on seconds without a known velocity among the inputs; also throws what
/// find_alignment() throws.
AlignmentResult choose_alignment(const log::Dataset& data, const Split& split,
                                 const std::string& states, const std::string& wish);

/// The inputs that are commands (find_commands() on the training rows); empty where no velocity is
/// known.
std::vector<std::string> commands_of(const log::Dataset& data, const Split& split,
                                     const std::string& states);

/// The alignment of an earlier model at this rate; `file` holds the model.
AlignmentResult alignment_at(const Alignment& alignment, double rate_hz, const std::string& file);

/// lag_intervals() on the training rows.
std::vector<LagInterval> lags_of(const log::Dataset& data, const Split& split,
                                 const Alignment& alignment);

/// The log in velocities through the water (through_water()), with its commands shifted and sent
/// through their actuators within stretches without a gap in time or a change of configuration
/// (AlignedRows). Times, targets and velocities stay in place. Requires a rate where there is
/// something to do. Throws InputError on a command that is no input.
log::Dataset aligned(log::Dataset data, const Alignment& alignment);

/// Alignment::text() and the reason.
std::string alignment_text(const AlignmentResult& found, double rate_hz);

}  // namespace kelpie::study
