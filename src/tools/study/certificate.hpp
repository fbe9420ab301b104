// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "simulator/engine.hpp"
#include "simulator/stability.hpp"

namespace kelpie::study {

/// Rows of a log for the engines of simulators: FRD, SI.
struct RecordedDrive {
  std::vector<double> times_s{};
  std::vector<simulator::Vector6> velocities{};  ///< measured; 0 on axes that don't move
  std::vector<Eigen::Quaterniond> attitudes{};   ///< body to NED; the heading doesn't matter
  std::vector<simulator::Vector6> forces{};      ///< of the thrusters, about the origin
  std::vector<std::size_t> starts{};             ///< first row of each stretch without a gap
  std::string rows_text{};                       ///< "held-out rows"

  std::size_t rows() const { return times_s.size(); }
  std::size_t end_of(std::size_t stretch) const {  ///< The row after the last.
    return stretch + 1 < starts.size() ? starts[stretch + 1] : rows();
  }
};

/// Agreement of driven and measured velocities at a time after the start.
struct DrivenHorizon {
  double seconds = 0.0;
  std::size_t starts = 0;      ///< rollouts that reach so far within a stretch
  std::array<double, 6> r2{};  ///< NaN on axes that don't move, and with fewer than two starts
};

/// The log driven again by an engine, and what the engine's step does to the vehicle.
struct Certificate {
  simulator::Engine engine;
  std::vector<DrivenHorizon> horizons{};
  simulator::StepLimit limit{};
};

/// The certificates of one identified vehicle.
struct CertificateList {
  std::string rows{};  ///< in words: the rows driven again
  std::array<bool, 6> free{};
  std::vector<Certificate> engines{};
};

/// Options of certify().
struct DriveStudy {
  std::array<double, 3> horizons_s{1.0, 10.0, 40.0};
  double start_every_s = 10.0;  ///< from one start to the next
};

/// Drives the rows again with every engine at its usual step, from measured velocities and
/// attitudes, with forces linear between rows; finds the largest stable steps (step_limit()), at
/// rest and at the rows where each axis is fastest. Cost: per engine the time of the log /
/// start_every_s × 40 s / step. Allocates.
CertificateList certify(std::span<const simulator::Engine> engines,
                        const simulator::EngineBody& body, const RecordedDrive& drive,
                        const DriveStudy& study = {});

}  // namespace kelpie::study
