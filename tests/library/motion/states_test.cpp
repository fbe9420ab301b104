// SPDX-License-Identifier: Apache-2.0
#include "motion/states.hpp"

#include <gtest/gtest.h>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::states_test {
namespace {

using testing::message_of;
using Indices = std::vector<std::size_t>;

const std::vector<std::string> kInputs{"u", "v", "r", "th1", "yaw_rate"};

TEST(States, AreFoundByNameWhereThereIsOnePerTarget) {
  EXPECT_EQ(find_states("auto", kInputs, 3), (Indices{0, 1, 2}));
  EXPECT_EQ(find_states("auto", kInputs, 2), Indices{});
  EXPECT_EQ(find_states("auto", std::vector<std::string>{"speed", "u"}, 1), Indices{});
  EXPECT_EQ(find_states("none", kInputs, 3), Indices{});
  EXPECT_EQ(find_states(" yaw_rate, u ", kInputs, 2), (Indices{4, 0}));
}

TEST(States, VelocitiesAreKnownByUsualNames) {
  const std::vector<std::vector<std::string>> known{
      {"u", "v", "w", "p", "q", "r"},
      {"surge", "Sway", "heave_velocity", "yaw_rate"},
      {"Vx", "Vy", "v_z", "rollrate"},
      {"twist.linear.x", "/dvl/twist.twist.linear.y", "imu.angular_velocity.z"}};
  for (const std::vector<std::string>& names : known) {
    EXPECT_EQ(named_velocities(names), names.size()) << names.front();
  }
  for (const std::string name : {"yaw", "roll", "depth", "accel.linear.x", "twist.linear",
                                 "linear.x", "vxx", "surge_dot", "", ".", "x"}) {
    EXPECT_EQ(named_velocities(std::vector<std::string>{name}), 0U) << name;
  }
}

TEST(States, NamesTellTheAxis) {
  EXPECT_EQ(velocity_axis("u"), 0U);
  EXPECT_EQ(velocity_axis("Sway_speed"), 1U);
  EXPECT_EQ(velocity_axis("twist.linear.z"), 2U);
  EXPECT_EQ(velocity_axis("roll_rate"), 3U);
  EXPECT_EQ(velocity_axis("imu/angular_velocity.y"), 4U);
  EXPECT_EQ(velocity_axis("/odom/twist.twist.angular.z"), 5U);
  EXPECT_EQ(velocity_axis("yaw"), std::nullopt);
  EXPECT_EQ(velocity_axis("twist.angular.w"), std::nullopt);
}

TEST(States, ADerivativeIsNamedAfterItsVelocity) {
  using Names = std::vector<std::string_view>;
  EXPECT_EQ(differentiated("udot"), (Names{"u"}));
  EXPECT_EQ(differentiated("du"), (Names{"u"}));
  EXPECT_EQ(differentiated("u_dot"), (Names{"u", "u_"}));
  EXPECT_TRUE(differentiated("u").empty());
  EXPECT_TRUE(differentiated("d").empty());
}

TEST(States, RefuseWhatIsNoInputNamingTheNearest) {
  const auto refusal = [](const char* states, std::size_t targets) {
    return message_of<InputError>([&] { find_states(states, kInputs, targets); });
  };
  EXPECT_EQ(refusal("u,yawrate", 2),
            "states: 'yawrate' is no input (did you mean 'yaw_rate'?); there are u, v, r, th1, "
            "yaw_rate");
  EXPECT_EQ(refusal("u,u", 2), "states: names 'u' twice");
  EXPECT_EQ(refusal("u,v", 3),
            "states: names 2 inputs; there are 3 targets, and each has its velocity");
}

}  // namespace
}  // namespace kelpie::states_test
