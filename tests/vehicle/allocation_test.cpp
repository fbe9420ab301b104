// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstddef>

#include "fixtures.hpp"
#include "kelpie/vehicle/simulator.hpp"

// Eigen allocates through malloc, past operator new, so malloc itself is counted. The sanitizers
// bring a malloc of their own.
#ifndef __SANITIZE_ADDRESS__
extern "C" void* __libc_malloc(std::size_t size);  // NOLINT: the C library's name

namespace {
std::size_t allocations = 0;  // NOLINT: malloc has nowhere else to count
}

extern "C" void* malloc(std::size_t size) noexcept {
  ++allocations;
  return __libc_malloc(size);
}
#endif

namespace kelpie {
namespace {

TEST(Allocation, ATickAllocatesNothing) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer counts allocations itself";
#else
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
#endif
}

}  // namespace
}  // namespace kelpie
