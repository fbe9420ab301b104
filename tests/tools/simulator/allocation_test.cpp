// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstddef>

#include "allocation_count.hpp"
#include "fixtures.hpp"
#include "simulator/simulator.hpp"

namespace kelpie::allocation_test {
namespace {

using testing::allocations;

TEST(Allocation, ATickAllocatesNothing) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  const simulator::VehicleParameters vehicle = testing::dagon();
  simulator::Configuration worn;
  worn.effectiveness(simulator::kSway) = 0.5;
  const simulator::Plant plant = testing::nominal(vehicle),
                         other = simulator::make_plant(vehicle, worn);
  simulator::Simulator simulator(vehicle, plant, Eigen::Vector3d::Zero(), simulator::State{});
  const std::size_t before = allocations;
  for (int tick = 0; tick < 1000; ++tick) {
    simulator.set_plant(simulator::blend(plant, other, tick / 1000.0));
    simulator.advance_in_plane({5.0, 3.0, -4.0});
  }
  EXPECT_EQ(allocations - before, 0U);
  testing::dagon();  // the count does count
  EXPECT_GT(allocations, before);
}

}  // namespace
}  // namespace kelpie::allocation_test
