// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "fmu/vehicle.hpp"
#include "kelpie/motion/unit.hpp"

namespace kelpie::fmu {

/// What a unit of FMI 2.0 says besides the model.
struct FmuOptions {
  std::string name = "vehicle";         ///< model name for hosts
  std::map<std::string, Unit> units{};  ///< of columns of the log
};

/// modelDescription.xml of a co-simulation unit (FMI 2.0.4, chapter 2.2). The value reference of a
/// variable is its place in Vehicle::variables(). The same model and options give the same bytes.
/// Throws InputError (`--units`) on the unit of a missing column.
std::string model_description(const Vehicle& vehicle, const std::string& guid,
                              const FmuOptions& options);

/// The content of an .fmu: modelDescription.xml, the model as resources/model.json, and the shared
/// object of this kelpie for this machine, under the standard's names. Throws InputError as Vehicle
/// and model_description(), Failure where the shared object is missing.
std::string fmu_content(const TrainedModel& model, const FmuOptions& options);

}  // namespace kelpie::fmu
