// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/log_options.hpp"
#include "motion/signal_names.hpp"
#include "study/six_axes.hpp"

namespace kelpie::cli {

/// The options of a command that identifies on six axes, beside those of the log.
struct SixAxisOptions {
  std::string vehicle;  ///< file
  std::string frame;
  std::string volts;
};

/// The options that `kelpie identify` and `kelpie plan` share, beside the logs, as given.
std::string identification_text(const IdentificationOptions& options, const SixAxisOptions& six);

/// Throws InputError (--volts) where a supply is given and the log is identified in the plane.
void refuse_volts_in_plane(const SixAxisOptions& six);

/// A log of six axes of the vehicle of a file.
struct SixAxisLog {
  study::LearnPlan plan;
  study::SixAxisColumns columns;
  Frame frame = Frame::frd;
  double neutral = kNeutralPulseUs;  ///< as of study::six_axis_rows()
  SixAxisSettings how{};
};

/// Makes the supply an input of the log, and measured states curves between messages: lines flatten
/// velocities that come slower than the rows. Throws InputError (--frame) on a wrong name, before a
/// log is read.
void begin_six_axes(const SixAxisOptions& six, PlanOptions& options);

/// Reads the log; nothing where columns are missing, which `why` then names. Throws as plan_log()
/// and study::six_axis_columns() do.
std::optional<SixAxisLog> six_axis_log(PlanOptions options, const SixAxisOptions& six,
                                       const simulator::VehicleParameters& vehicle,
                                       std::string& why);

/// Thrusts of --thrust, N per square of the log's unit, as of full commands.
std::vector<std::pair<std::string, double>> of_full_commands(
    std::vector<std::pair<std::string, double>> thrusts,
    const simulator::VehicleParameters& vehicle);

}  // namespace kelpie::cli
