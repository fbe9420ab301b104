// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "format/parameters.hpp"

namespace kelpie::parameters_yaml_test {
namespace {

TEST(ParametersYaml, HasNullWhereThereIsNoNumber) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  study::Identification found;
  found.targets = {"udot", "vdot", "rdot"};
  found.planar.parameters = {{"surge_inertia", 1.0, 0.0, ParameterState::known},
                             {"sway_inertia", kNone, -kNone, ParameterState::identified}};
  found.planar.misfit = kNone;
  found.planar.covariance = Matrix(2, 2);
  found.held_out.times_s = {0.0};
  found.held_out.r2 = {kNone, 0.5, -std::numeric_limits<double>::infinity()};
  found.held_out.free_r2 = {kNone, kNone, kNone};
  const std::string text = format::parameters_yaml(found, Frame::flu);
  EXPECT_EQ(text.find("nan"), std::string::npos) << text;
  EXPECT_EQ(text.find("inf"), std::string::npos) << text;
  EXPECT_NE(text.find("value: null, error: null, interval90: [null, null]"), std::string::npos)
      << text;
  EXPECT_NE(text.find("{vehicle: 0.5000,"), std::string::npos) << text;
}

}  // namespace
}  // namespace kelpie::parameters_yaml_test
