// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "simulator/scenario.hpp"
#include "study/drive_plan.hpp"

namespace kelpie::lab {

/// Who drives.
enum class Driver {
  planned,  ///< study::plan_drive() every leg
  random,   ///< every thruster's speed evenly distributed, held for 1 to 8 s
  pilot,    ///< wishes on a stick for all axes, evenly distributed, held for 1 to 6 s
};
inline constexpr std::array kDrivers{Driver::planned, Driver::random, Driver::pilot};
std::string driver_name(Driver driver);

/// A study of drives: the vehicle, in the plane or on six axes as the scenario's log, and what is
/// to be told. Parameters that the vehicle doesn't have (0) are not wanted.
struct DriveStudyPlan {
  simulator::Scenario scenario;
  std::size_t seeds = 20;
  std::vector<std::string> tell{};  ///< study::wanted_places()
  double share = 0.05;              ///< half width of the 90 % interval over the size
  double first_s = 60.0;            ///< of the drive before, the same for all
  double leg_s = 40.0;              ///< after which the vehicle is identified again
  double check_s = 5.0;             ///< between identifications that judge
  study::DriveBounds bounds{.time_s = 600.0, .speed_m_s = 0.8, .radius_m = 10.0};
  std::size_t threads = 0;
  std::function<bool(double)> keep_going = [](double) { return true; };
};

/// The drive of one driver and seed after the first drive.
struct DriveOutcome {
  double told_s = 0.0;  ///< until all was told, by kelpie identify; the longest time where never
  bool told = false;
  double error = 0.0;           ///< root mean square of the errors over the sizes at that time
  double expected = 0.0;        ///< planned: share expected by the first leg's plan over identify's
  study::DriveExtent extent{};  ///< of the vehicle
  std::vector<double> times_s{};  ///< since the first drive
  std::vector<double> worst{};    ///< greatest share over what is wanted, at these times
};

struct DriveStudy {
  std::vector<std::array<DriveOutcome, kDrivers.size()>> seeds;
  bool interrupted = false;
};

DriveStudy study_drives(const DriveStudyPlan& plan);

}  // namespace kelpie::lab
