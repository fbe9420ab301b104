// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstddef>

#include "allocation_count.hpp"
#include "fixtures.hpp"
#include "kelpie/vehicle/simulator.hpp"

namespace kelpie::allocation_test {
namespace {

using testing::allocations;

TEST(Allocation, ATickAllocatesNothing) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  const VehicleParameters vehicle = testing::dagon();
  Configuration worn;
  worn.effectiveness(kSway) = 0.5;
  const Plant plant = testing::nominal(vehicle), other = make_plant(vehicle, worn);
  Simulator simulator(vehicle, plant, Eigen::Vector3d::Zero(), State{});
  const std::size_t before = allocations;
  for (int tick = 0; tick < 1000; ++tick) {
    simulator.set_plant(blend(plant, other, tick / 1000.0));
    simulator.advance({5.0, 3.0, -4.0});
  }
  EXPECT_EQ(allocations - before, 0U);
  testing::dagon();  // the count does count
  EXPECT_GT(allocations, before);
}

}  // namespace
}  // namespace kelpie::allocation_test
