// SPDX-License-Identifier: Apache-2.0
#include "simulator/scenario.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "simulator/dynamics.hpp"
#include "simulator/simulator.hpp"
#include "simulator/tuning.hpp"

namespace kelpie::simulator {
namespace {

void validate_configuration(const VehicleParameters& vehicle, const Configuration& configuration,
                            const std::string& field) {
  configuration.validate(field);
  require(is_positive_definite(make_plant(vehicle, configuration).mass), field + ".payload",
          "makes the mass matrix not positive definite");
}

bool is_whole(double value) {
  return std::abs(value - std::round(value)) <= 1e-9 * value;
}

// Before a drive that would run for days, or fill the memory with rows.
void validate_length(const Scenario& scenario) {
  const double duration_s = scenario.duration_s();
  require(duration_s <= kTuning.longest_drive_s, "phases",
          fmt::format("take {:g} s together; at most {:g} s are simulated", duration_s,
                      kTuning.longest_drive_s));
  require(duration_s * scenario.rate_hz <= kTuning.most_rows, "phases",
          fmt::format("give {:g} rows together at {:g} Hz; at most {:g} are simulated",
                      duration_s * scenario.rate_hz, scenario.rate_hz, kTuning.most_rows));
}

void validate_phase(const Scenario& scenario, std::size_t index) {
  const Phase& phase = scenario.phases[index];
  const std::string field = fmt::format("phases[{}]", index);
  require(phase.configuration < scenario.configurations.size(), field + ".configuration",
          "does not exist");
  require(std::isfinite(phase.duration_s) && phase.duration_s > 0.0, field + ".duration_s",
          "must be above zero");
  require(
      is_whole(phase.duration_s * scenario.rate_hz) && ticks_in(phase.duration_s) > 0,
      field + ".duration_s",
      fmt::format("must be a whole number of sampling intervals of {} s", 1.0 / scenario.rate_hz));
  require(phase.amplitude >= 0.0 && phase.amplitude <= 1.0, field + ".amplitude",
          "must be between 0 and 1");
  require(phase.ramp_s >= 0.0 && phase.ramp_s <= phase.duration_s, field + ".ramp_s",
          "must be between 0 and the phase's duration");
  require(index > 0 || phase.ramp_s == 0.0, field + ".ramp_s",
          "has nothing to start from in the first phase");
}

}  // namespace

LogKind log_kind_from(const std::string& name) {
  const std::vector<std::string> names = {"planar", "six_axes"};
  return static_cast<LogKind>(require_name({}, name, "kind of log", names));
}

void Scenario::validate() const {
  vehicle.validate();
  if (log == LogKind::planar || excitation.in_plane()) {
    try {
      require_plane(vehicle);
    } catch (const InputError& error) {
      throw InputError("vehicle", std::string(error.what()) +
                                      "; other vehicles take log = \"six_axes\" and "
                                      "excitation.mode prbs, steps or pilot");
    }
  }
  require(std::isfinite(rate_hz) && rate_hz > 0.0, "rate_hz", "must be above zero");
  require(ticks_in(1.0 / rate_hz) > 0, "rate_hz",
          fmt::format("must divide {} Hz, the rate of the simulation", kTicksPerSecond));
  require(current_m_s.allFinite(), "current_m_s", "must be finite");
  excitation.validate();
  require(!configurations.empty(), "configurations", "there must be at least one");
  require(!phases.empty(), "phases", "there must be at least one");
  for (std::size_t i = 0; i < configurations.size(); ++i) {
    const SensorFault& sensors = configurations[i].sensors;
    require(log == LogKind::planar ||
                (sensors.scale.isOnes() && sensors.bias.isZero() && sensors.frozen.isZero()),
            fmt::format("configurations[{}].sensors", i),
            "works with log = \"planar\"; the log of six axes has no faults of sensors");
    validate_configuration(vehicle, configurations[i], fmt::format("configurations[{}]", i));
  }
  for (std::size_t i = 0; i < phases.size(); ++i) {
    validate_phase(*this, i);
  }
  validate_length(*this);
}

double Scenario::duration_s() const {
  return std::transform_reduce(phases.begin(), phases.end(), 0.0, std::plus<>(),
                               [](const Phase& phase) { return phase.duration_s; });
}

}  // namespace kelpie::simulator
