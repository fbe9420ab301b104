// SPDX-License-Identifier: Apache-2.0
#include "fmu/fmi2.hpp"

#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "fmu/guid.hpp"
#include "fmu/vehicle.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/trained_model.hpp"

namespace kelpie::fmu {
namespace {

// The calls that FMI 2.0 allows depend on the phase (chapter 4.2.4).
enum class Phase : std::uint8_t { instantiated, initialising, stepping, terminated };

struct Instance {
  std::string name;
  fmi2CallbackFunctions callbacks;
  bool logs;
  Vehicle vehicle;
  Vehicle before_start;  ///< what fmi2Reset() returns to
  Phase phase = Phase::instantiated;
  double start_s = 0.0;
};

Instance& instance_of(fmi2Component component) {
  return *static_cast<Instance*>(component);
}

void tell(const fmi2CallbackFunctions& callbacks, const std::string& name, fmi2Status status,
          const std::string& message) {
  if (callbacks.logger != nullptr) {
    callbacks.logger(callbacks.componentEnvironment, name.c_str(), status, "logStatusError", "%s",
                     message.c_str());
  }
}

fmi2Status refuse(fmi2Component component, const std::string& message) {
  if (component != nullptr && instance_of(component).logs) {
    tell(instance_of(component).callbacks, instance_of(component).name, fmi2Error, message);
  }
  return fmi2Error;
}

// No exception leaves the shared object.
template <typename Action>
fmi2Status guarded(fmi2Component component, Action action) noexcept {
  try {
    if (component == nullptr) {
      return fmi2Error;
    }
    action(instance_of(component));
    return fmi2OK;
  } catch (const std::exception& error) {
    return refuse(component, error.what());
  }
}

void require_phase(const Instance& instance, Phase phase, const char* function) {
  require(instance.phase == phase, function, "is called in another order than FMI 2.0 allows");
}

// "file:///tmp/twin/resources" or "file:/tmp/twin/resources", with %20 for a space.
std::filesystem::path path_of(std::string_view location) {
  if (location.starts_with("file:")) {
    location.remove_prefix(5);
    if (location.starts_with("//")) {
      location.remove_prefix(std::min(location.find('/', 2), location.size()));
    }
  }
  std::string path;
  for (std::size_t i = 0; i < location.size(); ++i) {
    if (location[i] == '%' && i + 2 < location.size()) {
      path += static_cast<char>(std::stoi(std::string(location.substr(i + 1, 2)), nullptr, 16));
      i += 2;
    } else {
      path += location[i];
    }
  }
  return path;
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  require(stream.is_open(), file.string(), "cannot be read");
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::unique_ptr<Instance> instantiate(const char* name, fmi2Type type, const char* guid,
                                      const char* resources, const fmi2CallbackFunctions& callbacks,
                                      bool logs) {
  require(type == fmi2CoSimulation, "fmuType", "has to be co-simulation");
  const std::filesystem::path file = path_of(resources) / "model.json";
  const std::string text = read_text(file);
  require(guid_of(text) == guid, "guid", "is not that of " + file.string());
  const Vehicle vehicle(read_trained_model(text, file.string()));
  return std::make_unique<Instance>(Instance{name, callbacks, logs, vehicle, vehicle});
}

void check_references(const Instance& instance, const fmi2ValueReference variables[],
                      std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    require(variables[i] < instance.vehicle.variables().size(), "value reference",
            std::to_string(variables[i]) + " belongs to no variable");
  }
}

void set_reals(Instance& instance, const fmi2ValueReference variables[], std::size_t count,
               const double values[]) {
  check_references(instance, variables, count);
  for (std::size_t i = 0; i < count; ++i) {
    const Variable& variable = instance.vehicle.variables()[variables[i]];
    const bool before_steps = instance.phase <= Phase::initialising;
    require(variable.role == Role::input || (variable.role == Role::state && before_steps),
            variable.name,
            variable.role == Role::state ? "can be set before the first step only"
                                         : "is a result and cannot be set");
    require(std::isfinite(values[i]), variable.name, "has to be a finite number");
  }
  for (std::size_t i = 0; i < count; ++i) {
    instance.vehicle.set(variables[i], values[i]);
  }
}

void get_reals(Instance& instance, const fmi2ValueReference variables[], std::size_t count,
               double values[]) {
  check_references(instance, variables, count);
  if (instance.phase <= Phase::initialising) {
    instance.vehicle.start(instance.start_s);  // accelerations at the values set so far
  }
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = instance.vehicle.value(variables[i]);
  }
}

void do_step(Instance& instance, double step_s) {
  require_phase(instance, Phase::stepping, "fmi2DoStep");
  instance.vehicle.advance(step_s);
  require(instance.vehicle.is_finite(), "fmi2DoStep", "ended in a number that is not finite");
}

}  // namespace

fmi2String fmi2GetTypesPlatform() {
  return "default";
}

fmi2String fmi2GetVersion() {
  return "2.0";
}

fmi2Status fmi2SetDebugLogging(fmi2Component vehicle, fmi2Boolean on, std::size_t /*count*/,
                               const fmi2String /*categories*/[]) {
  return guarded(vehicle, [&](Instance& instance) { instance.logs = on != 0; });
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions* functions, fmi2Boolean /*visible*/,
                              fmi2Boolean logging) {
  if (functions == nullptr || name == nullptr || guid == nullptr || resources == nullptr) {
    return nullptr;
  }
  try {
    return instantiate(name, type, guid, resources, *functions, logging != 0).release();
  } catch (const std::exception& error) {
    tell(*functions, name, fmi2Error, error.what());
    return nullptr;
  }
}

void fmi2FreeInstance(fmi2Component vehicle) {
  delete static_cast<Instance*>(vehicle);
}

fmi2Status fmi2SetupExperiment(fmi2Component vehicle, fmi2Boolean /*has_tolerance*/,
                               fmi2Real /*tolerance*/, fmi2Real start, fmi2Boolean /*has_stop*/,
                               fmi2Real /*stop*/) {
  return guarded(vehicle, [&](Instance& instance) {
    require_phase(instance, Phase::instantiated, "fmi2SetupExperiment");
    require(std::isfinite(start), "startTime", "has to be a finite number");
    instance.start_s = start;
  });
}

fmi2Status fmi2EnterInitializationMode(fmi2Component vehicle) {
  return guarded(vehicle, [](Instance& instance) {
    require_phase(instance, Phase::instantiated, "fmi2EnterInitializationMode");
    instance.phase = Phase::initialising;
  });
}

fmi2Status fmi2ExitInitializationMode(fmi2Component vehicle) {
  return guarded(vehicle, [](Instance& instance) {
    require_phase(instance, Phase::initialising, "fmi2ExitInitializationMode");
    instance.vehicle.start(instance.start_s);
    instance.phase = Phase::stepping;
  });
}

fmi2Status fmi2Terminate(fmi2Component vehicle) {
  return guarded(vehicle, [](Instance& instance) { instance.phase = Phase::terminated; });
}

fmi2Status fmi2Reset(fmi2Component vehicle) {
  return guarded(vehicle, [](Instance& instance) {
    instance.vehicle = instance.before_start;
    instance.phase = Phase::instantiated;
  });
}

fmi2Status fmi2GetReal(fmi2Component vehicle, const fmi2ValueReference variables[],
                       std::size_t count, fmi2Real values[]) {
  return guarded(vehicle,
                 [&](Instance& instance) { get_reals(instance, variables, count, values); });
}

fmi2Status fmi2SetReal(fmi2Component vehicle, const fmi2ValueReference variables[],
                       std::size_t count, const fmi2Real values[]) {
  return guarded(vehicle,
                 [&](Instance& instance) { set_reals(instance, variables, count, values); });
}

// All variables are real: lists of other types have to be empty.
namespace {

fmi2Status none_of(fmi2Component vehicle, std::size_t count) {
  return count == 0 ? fmi2OK : refuse(vehicle, "all variables are real");
}

}  // namespace

fmi2Status fmi2GetInteger(fmi2Component vehicle, const fmi2ValueReference /*variables*/[],
                          std::size_t count, fmi2Integer /*values*/[]) {
  return none_of(vehicle, count);
}

fmi2Status fmi2GetBoolean(fmi2Component vehicle, const fmi2ValueReference /*variables*/[],
                          std::size_t count, fmi2Boolean /*values*/[]) {
  return none_of(vehicle, count);
}

fmi2Status fmi2GetString(fmi2Component vehicle, const fmi2ValueReference /*variables*/[],
                         std::size_t count, fmi2String /*values*/[]) {
  return none_of(vehicle, count);
}

fmi2Status fmi2SetInteger(fmi2Component vehicle, const fmi2ValueReference /*variables*/[],
                          std::size_t count, const fmi2Integer /*values*/[]) {
  return none_of(vehicle, count);
}

fmi2Status fmi2SetBoolean(fmi2Component vehicle, const fmi2ValueReference /*variables*/[],
                          std::size_t count, const fmi2Boolean /*values*/[]) {
  return none_of(vehicle, count);
}

fmi2Status fmi2SetString(fmi2Component vehicle, const fmi2ValueReference /*variables*/[],
                         std::size_t count, const fmi2String /*values*/[]) {
  return none_of(vehicle, count);
}

namespace {

// A state kept: the vehicle of a moment and its phase.
struct Kept {
  Vehicle vehicle;
  Phase phase;
};

}  // namespace

fmi2Status fmi2GetFMUstate(fmi2Component vehicle, fmi2FMUstate* state) {
  return guarded(vehicle, [&](const Instance& instance) {
    auto kept = std::make_unique<Kept>(Kept{instance.vehicle, instance.phase});
    delete static_cast<Kept*>(*state);
    *state = kept.release();
  });
}

fmi2Status fmi2SetFMUstate(fmi2Component vehicle, fmi2FMUstate state) {
  return guarded(vehicle, [&](Instance& instance) {
    require(state != nullptr, "FMUstate", "is no state kept");
    const auto& kept = *static_cast<const Kept*>(state);
    instance.vehicle = kept.vehicle;
    instance.phase = kept.phase;
  });
}

fmi2Status fmi2FreeFMUstate(fmi2Component vehicle, fmi2FMUstate* state) {
  return guarded(vehicle, [&](Instance&) {
    delete static_cast<Kept*>(*state);
    *state = nullptr;
  });
}

// modelDescription.xml offers none of the following.
fmi2Status fmi2SerializedFMUstateSize(fmi2Component vehicle, fmi2FMUstate /*state*/,
                                      std::size_t* /*size*/) {
  return refuse(vehicle, "states are not serialised");
}

fmi2Status fmi2SerializeFMUstate(fmi2Component vehicle, fmi2FMUstate /*state*/,
                                 fmi2Byte /*bytes*/[], std::size_t /*size*/) {
  return refuse(vehicle, "states are not serialised");
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component vehicle, const fmi2Byte /*bytes*/[],
                                   std::size_t /*size*/, fmi2FMUstate* /*state*/) {
  return refuse(vehicle, "states are not serialised");
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component vehicle,
                                        const fmi2ValueReference /*unknowns*/[],
                                        std::size_t /*unknown_count*/,
                                        const fmi2ValueReference /*knowns*/[],
                                        std::size_t /*known_count*/, const fmi2Real /*steps*/[],
                                        fmi2Real /*changes*/[]) {
  return refuse(vehicle, "has no directional derivatives");
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component vehicle,
                                       const fmi2ValueReference /*variables*/[],
                                       std::size_t /*count*/, const fmi2Integer /*orders*/[],
                                       const fmi2Real /*values*/[]) {
  return refuse(vehicle, "inputs are held over a step");
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component vehicle,
                                        const fmi2ValueReference /*variables*/[],
                                        std::size_t /*count*/, const fmi2Integer /*orders*/[],
                                        fmi2Real /*values*/[]) {
  return refuse(vehicle, "has no derivatives of outputs");
}

fmi2Status fmi2DoStep(fmi2Component vehicle, fmi2Real /*t*/, fmi2Real step,
                      fmi2Boolean /*no_return*/) {
  return guarded(vehicle, [&](Instance& instance) { do_step(instance, step); });
}

// Steps end before they return: none waits.
fmi2Status fmi2CancelStep(fmi2Component vehicle) {
  return refuse(vehicle, "no step is under way");
}

fmi2Status fmi2GetStatus(fmi2Component vehicle, fmi2StatusKind /*kind*/, fmi2Status* /*value*/) {
  return refuse(vehicle, "no step is under way");
}

fmi2Status fmi2GetRealStatus(fmi2Component vehicle, fmi2StatusKind kind, fmi2Real* value) {
  return guarded(vehicle, [&](const Instance& instance) {
    require(kind == fmi2LastSuccessfulTime, "status kind", "has no real value");
    *value = instance.vehicle.time_s();
  });
}

fmi2Status fmi2GetIntegerStatus(fmi2Component vehicle, fmi2StatusKind /*kind*/,
                                fmi2Integer* /*value*/) {
  return refuse(vehicle, "no status is an integer");
}

fmi2Status fmi2GetBooleanStatus(fmi2Component vehicle, fmi2StatusKind kind, fmi2Boolean* value) {
  return guarded(vehicle, [&](const Instance& instance) {
    require(kind == fmi2Terminated, "status kind", "has no boolean value");
    *value = instance.phase == Phase::terminated ? 1 : 0;
  });
}

fmi2Status fmi2GetStringStatus(fmi2Component vehicle, fmi2StatusKind /*kind*/,
                               fmi2String* /*value*/) {
  return refuse(vehicle, "no step is under way");
}

}  // namespace kelpie::fmu
