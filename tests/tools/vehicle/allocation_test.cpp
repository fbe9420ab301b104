// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstddef>

#include "allocation_count.hpp"
#include "fixtures.hpp"
#include "vehicle/simulator.hpp"

namespace kelpie::allocation_test {
namespace {

using testing::allocations;

TEST(Allocation, ATickAllocatesNothing) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  const vehicle::VehicleParameters vehicle = testing::dagon();
  vehicle::Configuration worn;
  worn.effectiveness(vehicle::kSway) = 0.5;
  const vehicle::Plant plant = testing::nominal(vehicle),
                       other = vehicle::make_plant(vehicle, worn);
  vehicle::Simulator simulator(vehicle, plant, Eigen::Vector3d::Zero(), vehicle::State{});
  const std::size_t before = allocations;
  for (int tick = 0; tick < 1000; ++tick) {
    simulator.set_plant(vehicle::blend(plant, other, tick / 1000.0));
    simulator.advance_in_plane({5.0, 3.0, -4.0});
  }
  EXPECT_EQ(allocations - before, 0U);
  testing::dagon();  // the count does count
  EXPECT_GT(allocations, before);
}

}  // namespace
}  // namespace kelpie::allocation_test
