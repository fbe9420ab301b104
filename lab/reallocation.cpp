// SPDX-License-Identifier: Apache-2.0
#include "lab/reallocation.hpp"

#include <array>
#include <utility>

namespace kelpie::lab {
namespace {

constexpr std::size_t kLookPeriods = 10;  // a diagnosis has blocks of 2 s at 5 Hz
constexpr double kHealthy = 0.93;         // share of thrust from which nothing is re-allocated

}  // namespace

Eigen::Vector3d Reallocation::look(const Diagnosis* diagnosis, const Eigen::Vector3d& rotors_rps) {
  if (++periods_ % kLookPeriods != 0 || diagnosis == nullptr || diagnosis->found() == 0 ||
      !diagnosis->knows_thrust()) {
    return Eigen::Vector3d::Zero();
  }
  std::vector<CommandRange> ranges;
  for (std::size_t i = 0; i < 3; ++i) {
    const double most = nominal_.most_rps(static_cast<Eigen::Index>(i));
    ranges.push_back({3 + i, -most, most});
  }
  Authority authority(*diagnosis, ranges);
  const Eigen::Vector3d before = forces(rotors_rps);
  bool damaged = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const double share = authority.thrusters()[i].share;
    damaged = damaged || share < kHealthy;
    shares_(static_cast<Eigen::Index>(i)) = share < kHealthy ? share : 1.0;
  }
  authority_.reset();
  if (damaged) {
    authority_.emplace(std::move(authority));
  }
  return before - forces(rotors_rps);
}

Eigen::Vector3d Reallocation::allocate(const Eigen::Vector3d& forces) const {
  if (!authority_) {
    return nominal_.allocate(forces);
  }
  const Eigen::Vector3d wanted = forces.cwiseQuotient(nominal_.mass);
  const Allocation allocation = authority_->allocate(std::array{wanted(0), wanted(1), wanted(2)});
  return Eigen::Map<const Eigen::Vector3d>(allocation.commands.data());
}

Eigen::Vector3d Reallocation::forces(const Eigen::Vector3d& speeds_rps) const {
  return nominal_.by_thrust * shares_.cwiseProduct(nominal_.thrusts(speeds_rps));
}

}  // namespace kelpie::lab
