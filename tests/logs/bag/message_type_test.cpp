// SPDX-License-Identifier: Apache-2.0
#include "bag/message_type.hpp"

#include <gtest/gtest.h>

#include "bag/bags.hpp"
#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::message_type_test {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;
using testing::write_text;

std::vector<std::string> paths_of(const bag::MessageType& type) {
  std::vector<std::string> paths;
  paths.reserve(type.leaves.size());
  for (const bag::MessageType::Leaf& leaf : type.leaves) {
    paths.push_back(leaf.path);
  }
  return paths;
}

std::string refusal(const std::string& text) {
  return testing::message_of<InputError>(
      [&] { bag::MessageDefinitions().type("test_msgs/msg/Test", text); });
}

TEST(MessageType, ConstantsDefaultsAndCommentsAreNoFields) {
  const bag::MessageType type = bag::MessageDefinitions().type("a/B",
                                                               "# head\r\n"
                                                               "uint8 ON=1\r\n"
                                                               "string NAME = \"x # y\"\n"
                                                               "\n"
                                                               "  float64   x   1.5  # a default\n"
                                                               "string<=5 s \"a = b\"\n"
                                                               "int32[] v [1, 2]\n");
  EXPECT_EQ(paths_of(type), (std::vector<std::string>{"x", "s", "v[]"}));
}

TEST(MessageType, BuiltInTypesAreThoseAVehicleLogs) {
  const bag::MessageDefinitions definitions;
  EXPECT_EQ(definitions.type("nav_msgs/msg/Odometry").find("twist.twist.angular.z"), 17U);
  for (const char* const name :
       {"geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped",
        "geometry_msgs/msg/TwistWithCovarianceStamped", "sensor_msgs/msg/Imu",
        "sensor_msgs/msg/JointState", "std_msgs/msg/Float64MultiArray", "std_msgs/msg/Empty"}) {
    EXPECT_NO_THROW(definitions.type(name)) << name;
  }
  EXPECT_EQ(paths_of(definitions.type("std_msgs/msg/Float64MultiArray")),
            (std::vector<std::string>{"layout.dim[].label", "layout.dim[].size",
                                      "layout.dim[].stride", "layout.data_offset", "data[]"}));
}

TEST(MessageType, BuiltInTypesAreThoseOfUnderwaterVehicles) {
  const bag::MessageDefinitions definitions;
  // Leaves in the order of storage: a wrong or missing field shifts the last one.
  for (const auto& [name, path, leaf] :
       {std::tuple("geometry_msgs/msg/Pose", "orientation.w", 6U),
        std::tuple("geometry_msgs/msg/Twist", "angular.z", 5U),
        std::tuple("geometry_msgs/msg/TwistStamped", "twist.angular.z", 8U),
        std::tuple("geometry_msgs/msg/TwistWithCovariance", "covariance[]", 6U),
        std::tuple("geometry_msgs/msg/TwistWithCovarianceStamped", "twist.covariance[]", 9U),
        std::tuple("geometry_msgs/msg/Wrench", "torque.z", 5U),
        std::tuple("geometry_msgs/msg/WrenchStamped", "wrench.torque.z", 8U),
        std::tuple("geometry_msgs/msg/Accel", "angular.z", 5U),
        std::tuple("geometry_msgs/msg/AccelStamped", "accel.angular.z", 8U),
        std::tuple("geometry_msgs/msg/AccelWithCovariance", "covariance[]", 6U),
        std::tuple("geometry_msgs/msg/AccelWithCovarianceStamped", "accel.covariance[]", 9U),
        std::tuple("sensor_msgs/msg/Imu", "linear_acceleration_covariance[]", 15U),
        std::tuple("geometry_msgs/msg/PoseStamped", "pose.orientation.w", 9U),
        std::tuple("geometry_msgs/msg/PoseWithCovarianceStamped", "pose.covariance[]", 10U),
        std::tuple("geometry_msgs/msg/TransformStamped", "transform.rotation.w", 10U),
        std::tuple("tf2_msgs/msg/TFMessage", "transforms[].transform.rotation.w", 10U),
        std::tuple("sensor_msgs/msg/BatteryState", "serial_number", 17U),
        std::tuple("sensor_msgs/msg/FluidPressure", "variance", 4U),
        std::tuple("sensor_msgs/msg/NavSatFix", "position_covariance_type", 9U),
        std::tuple("mavros_msgs/msg/RCOut", "channels[]", 3U),
        std::tuple("mavros_msgs/msg/RCIn", "channels[]", 4U),
        std::tuple("mavros_msgs/msg/OverrideRCIn", "channels[]", 0U),
        std::tuple("mavros_msgs/msg/State", "system_status", 8U),
        std::tuple("marine_acoustic_msgs/msg/Dvl", "beam_velocity_covar[]", 23U),
        std::tuple("dvl_msgs/msg/DVL", "form", 20U),
        std::tuple("waterlinked_a50_ros_driver/msg/DVL", "form", 17U),
        std::tuple("uuv_sensor_ros_plugins_msgs/msg/DVL", "beams[].pose.pose.orientation.w",
                   21U)}) {
    EXPECT_EQ(definitions.type(name).find(path), leaf) << name;
  }
}

TEST(MessageType, FilesOfAFolderAreFoundInAnyOfItsLayouts) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "a/msg");
  fs::create_directories(folder / "b");
  write_text(folder / "a/msg/A.msg", "b/B b\nC c\nHeader header\n");
  write_text(folder / "b/B.msg", "float64 x\n");
  write_text(folder / "C.msg", "float64 y\n");
  EXPECT_EQ(paths_of(bag::MessageDefinitions(folder.path()).type("a/msg/A")),
            (std::vector<std::string>{"b.x", "c.y", "header.stamp.sec", "header.stamp.nanosec",
                                      "header.frame_id"}));
  EXPECT_NE(testing::message_of<InputError>([&] {
              bag::MessageDefinitions(folder / "none");
            }).find("is not a folder"),
            std::string::npos);
}

TEST(MessageType, FullTextStandsOnItsOwn) {
  const std::string text = bag::MessageDefinitions().full_text("nav_msgs/msg/Odometry");
  const bag::MessageType again = bag::MessageDefinitions().type("nav_msgs/msg/Odometry", text);
  EXPECT_EQ(paths_of(again), paths_of(bag::MessageDefinitions().type("nav_msgs/msg/Odometry")));
  EXPECT_NE(text.find("\nMSG: builtin_interfaces/Time\nint32 sec\n"), std::string::npos);
}

TEST(MessageType, WhatIsNoDefinitionIsRefusedWithItsLine) {
  EXPECT_EQ(refusal("float64 x\nfloat64\n").substr(0, 47),
            "test_msgs/Test, line 2: 'float64' is no field: ");
  for (const char* const line :
       {"float64[ x", "float64] x", "float64[0] x", "float64[<=] x", "float64[-1] x", "string<=x s",
        "float64 2x", "float64 a-b", "float64[99999999999] x", "/ x", "=== x"}) {
    EXPECT_NE(refusal(std::string(line) + "\n"), "") << line;
  }
  EXPECT_NE(refusal("float64 x\nint8 x\n").find("two fields x"), std::string::npos);
  EXPECT_NE(refusal("wstring w\n").find("wstring"), std::string::npos);
  EXPECT_NE(refusal("other_msgs/Thing t\n").find("other_msgs/Thing: its definition is neither"),
            std::string::npos);
}

TEST(MessageType, TypesThatGrowWithoutEndAreRefused) {
  EXPECT_NE(refusal("Test again\n").find("holds itself"), std::string::npos);
  std::string doubling = "T0 a\n";
  for (int k = 0; k < 25; ++k) {
    const std::string next = "T" + std::to_string(k + 1);
    doubling += "====\nMSG: test_msgs/T" + std::to_string(k) + "\n" + next + " a\n" + next + " b\n";
  }
  EXPECT_NE(refusal(doubling + "====\nMSG: test_msgs/T25\nint8 x\n").find("more than 20000 fields"),
            std::string::npos);
}

TEST(MessageType, ANameOfAFieldIsNotLongerThanPeopleWrite) {
  EXPECT_EQ(refusal("int8 " + std::string(200, 'a') + "\n"), "");
  EXPECT_NE(refusal("int8 " + std::string(201, 'a') + "\n").find("longer than 200 bytes"),
            std::string::npos);
}

TEST(MessageType, NamesOfTypesAreNoPaths) {
  const TemporaryFolder folder;
  const bag::MessageDefinitions definitions(folder.path());
  for (const char* const name : {"../secret", "a/../b", "/etc/passwd", "a/msg/", "a", ""}) {
    EXPECT_THROW(definitions.type(name), InputError) << name;
  }
}

}  // namespace
}  // namespace kelpie::message_type_test
