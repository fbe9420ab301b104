// SPDX-License-Identifier: Apache-2.0
// The C interface of FMI 2.0 (Functional Mock-up Interface 2.0.4, chapters 2.1 and 4.2): types and
// functions by the standard's names, which hosts look up in the shared object.
#pragma once

#include <cstddef>

namespace kelpie::fmu {

// NOLINTBEGIN(readability-identifier-naming): names of the standard
extern "C" {

using fmi2Component = void*;
using fmi2ComponentEnvironment = void*;
using fmi2FMUstate = void*;
using fmi2ValueReference = unsigned int;
using fmi2Real = double;
using fmi2Integer = int;
using fmi2Boolean = int;
using fmi2String = const char*;
using fmi2Byte = char;

enum fmi2Status { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending };
enum fmi2Type { fmi2ModelExchange, fmi2CoSimulation };
enum fmi2StatusKind { fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated };

struct fmi2CallbackFunctions {
  void (*logger)(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status,
                 fmi2String category, fmi2String message, ...);
  void* (*allocateMemory)(std::size_t count, std::size_t size);
  void (*freeMemory)(void* memory);
  void (*stepFinished)(fmi2ComponentEnvironment environment, fmi2Status status);
  fmi2ComponentEnvironment componentEnvironment;
};

#define KELPIE_FMI2 __attribute__((visibility("default")))

// Any part of a life
KELPIE_FMI2 fmi2String fmi2GetTypesPlatform();
KELPIE_FMI2 fmi2String fmi2GetVersion();
KELPIE_FMI2 fmi2Status fmi2SetDebugLogging(fmi2Component vehicle, fmi2Boolean on, std::size_t count,
                                           const fmi2String categories[]);
KELPIE_FMI2 fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid,
                                          fmi2String resources,
                                          const fmi2CallbackFunctions* functions,
                                          fmi2Boolean visible, fmi2Boolean logging);
KELPIE_FMI2 void fmi2FreeInstance(fmi2Component vehicle);
KELPIE_FMI2 fmi2Status fmi2SetupExperiment(fmi2Component vehicle, fmi2Boolean has_tolerance,
                                           fmi2Real tolerance, fmi2Real start, fmi2Boolean has_stop,
                                           fmi2Real stop);
KELPIE_FMI2 fmi2Status fmi2EnterInitializationMode(fmi2Component vehicle);
KELPIE_FMI2 fmi2Status fmi2ExitInitializationMode(fmi2Component vehicle);
KELPIE_FMI2 fmi2Status fmi2Terminate(fmi2Component vehicle);
KELPIE_FMI2 fmi2Status fmi2Reset(fmi2Component vehicle);

// Values
KELPIE_FMI2 fmi2Status fmi2GetReal(fmi2Component vehicle, const fmi2ValueReference variables[],
                                   std::size_t count, fmi2Real values[]);
KELPIE_FMI2 fmi2Status fmi2GetInteger(fmi2Component vehicle, const fmi2ValueReference variables[],
                                      std::size_t count, fmi2Integer values[]);
KELPIE_FMI2 fmi2Status fmi2GetBoolean(fmi2Component vehicle, const fmi2ValueReference variables[],
                                      std::size_t count, fmi2Boolean values[]);
KELPIE_FMI2 fmi2Status fmi2GetString(fmi2Component vehicle, const fmi2ValueReference variables[],
                                     std::size_t count, fmi2String values[]);
KELPIE_FMI2 fmi2Status fmi2SetReal(fmi2Component vehicle, const fmi2ValueReference variables[],
                                   std::size_t count, const fmi2Real values[]);
KELPIE_FMI2 fmi2Status fmi2SetInteger(fmi2Component vehicle, const fmi2ValueReference variables[],
                                      std::size_t count, const fmi2Integer values[]);
KELPIE_FMI2 fmi2Status fmi2SetBoolean(fmi2Component vehicle, const fmi2ValueReference variables[],
                                      std::size_t count, const fmi2Boolean values[]);
KELPIE_FMI2 fmi2Status fmi2SetString(fmi2Component vehicle, const fmi2ValueReference variables[],
                                     std::size_t count, const fmi2String values[]);

// States kept
KELPIE_FMI2 fmi2Status fmi2GetFMUstate(fmi2Component vehicle, fmi2FMUstate* state);
KELPIE_FMI2 fmi2Status fmi2SetFMUstate(fmi2Component vehicle, fmi2FMUstate state);
KELPIE_FMI2 fmi2Status fmi2FreeFMUstate(fmi2Component vehicle, fmi2FMUstate* state);
KELPIE_FMI2 fmi2Status fmi2SerializedFMUstateSize(fmi2Component vehicle, fmi2FMUstate state,
                                                  std::size_t* size);
KELPIE_FMI2 fmi2Status fmi2SerializeFMUstate(fmi2Component vehicle, fmi2FMUstate state,
                                             fmi2Byte bytes[], std::size_t size);
KELPIE_FMI2 fmi2Status fmi2DeSerializeFMUstate(fmi2Component vehicle, const fmi2Byte bytes[],
                                               std::size_t size, fmi2FMUstate* state);
KELPIE_FMI2 fmi2Status fmi2GetDirectionalDerivative(fmi2Component vehicle,
                                                    const fmi2ValueReference unknowns[],
                                                    std::size_t unknown_count,
                                                    const fmi2ValueReference knowns[],
                                                    std::size_t known_count, const fmi2Real steps[],
                                                    fmi2Real changes[]);

// Co-simulation
KELPIE_FMI2 fmi2Status fmi2SetRealInputDerivatives(fmi2Component vehicle,
                                                   const fmi2ValueReference variables[],
                                                   std::size_t count, const fmi2Integer orders[],
                                                   const fmi2Real values[]);
KELPIE_FMI2 fmi2Status fmi2GetRealOutputDerivatives(fmi2Component vehicle,
                                                    const fmi2ValueReference variables[],
                                                    std::size_t count, const fmi2Integer orders[],
                                                    fmi2Real values[]);
KELPIE_FMI2 fmi2Status fmi2DoStep(fmi2Component vehicle, fmi2Real t, fmi2Real step,
                                  fmi2Boolean no_return);
KELPIE_FMI2 fmi2Status fmi2CancelStep(fmi2Component vehicle);
KELPIE_FMI2 fmi2Status fmi2GetStatus(fmi2Component vehicle, fmi2StatusKind kind, fmi2Status* value);
KELPIE_FMI2 fmi2Status fmi2GetRealStatus(fmi2Component vehicle, fmi2StatusKind kind,
                                         fmi2Real* value);
KELPIE_FMI2 fmi2Status fmi2GetIntegerStatus(fmi2Component vehicle, fmi2StatusKind kind,
                                            fmi2Integer* value);
KELPIE_FMI2 fmi2Status fmi2GetBooleanStatus(fmi2Component vehicle, fmi2StatusKind kind,
                                            fmi2Boolean* value);
KELPIE_FMI2 fmi2Status fmi2GetStringStatus(fmi2Component vehicle, fmi2StatusKind kind,
                                           fmi2String* value);
}
// NOLINTEND(readability-identifier-naming)

}  // namespace kelpie::fmu
