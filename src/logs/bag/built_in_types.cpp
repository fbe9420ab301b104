// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "bag/message_text.hpp"

namespace kelpie::bag {
namespace {

// The layouts of ROS 2's common_interfaces and rcl_interfaces, unchanged from Foxy to Jazzy, and of
// messages that underwater vehicles have besides.
constexpr auto kDefinitions = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
    {"std_msgs/Empty", "\n"},
    {"std_msgs/Bool", "bool data\n"},
    {"std_msgs/Float64", "float64 data\n"},
    {"std_msgs/Float32", "float32 data\n"},
    {"std_msgs/Int16", "int16 data\n"},
    {"std_msgs/UInt16", "uint16 data\n"},
    {"std_msgs/Int32", "int32 data\n"},
    {"std_msgs/String", "string data\n"},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    {"std_msgs/MultiArrayDimension", "string label\nuint32 size\nuint32 stride\n"},
    {"std_msgs/MultiArrayLayout", "MultiArrayDimension[] dim\nuint32 data_offset\n"},
    {"std_msgs/Float64MultiArray", "MultiArrayLayout layout\nfloat64[] data\n"},
    {"std_msgs/Float32MultiArray", "MultiArrayLayout layout\nfloat32[] data\n"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
    {"geometry_msgs/Pose", "Point position\nQuaternion orientation\n"},
    {"geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance\n"},
    {"geometry_msgs/PoseStamped", "std_msgs/Header header\nPose pose\n"},
    {"geometry_msgs/PoseWithCovarianceStamped",
     "std_msgs/Header header\nPoseWithCovariance pose\n"},
    {"geometry_msgs/PointStamped", "std_msgs/Header header\nPoint point\n"},
    {"geometry_msgs/QuaternionStamped", "std_msgs/Header header\nQuaternion quaternion\n"},
    {"geometry_msgs/Vector3Stamped", "std_msgs/Header header\nVector3 vector\n"},
    {"geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation\n"},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\nTransform transform\n"},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    {"geometry_msgs/Twist", "Vector3 linear\nVector3 angular\n"},
    {"geometry_msgs/TwistStamped", "std_msgs/Header header\nTwist twist\n"},
    {"geometry_msgs/TwistWithCovariance", "Twist twist\nfloat64[36] covariance\n"},
    {"geometry_msgs/TwistWithCovarianceStamped",
     "std_msgs/Header header\nTwistWithCovariance twist\n"},
    {"geometry_msgs/Accel", "Vector3 linear\nVector3 angular\n"},
    {"geometry_msgs/AccelStamped", "std_msgs/Header header\nAccel accel\n"},
    {"geometry_msgs/AccelWithCovariance", "Accel accel\nfloat64[36] covariance\n"},
    {"geometry_msgs/AccelWithCovarianceStamped",
     "std_msgs/Header header\nAccelWithCovariance accel\n"},
    {"geometry_msgs/Wrench", "Vector3 force\nVector3 torque\n"},
    {"geometry_msgs/WrenchStamped", "std_msgs/Header header\nWrench wrench\n"},
    {"nav_msgs/Odometry",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
     "geometry_msgs/TwistWithCovariance twist\n"},
    {"diagnostic_msgs/KeyValue", "string key\nstring value\n"},
    {"diagnostic_msgs/DiagnosticStatus",
     "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\nbyte level\nstring name\n"
     "string message\nstring hardware_id\nKeyValue[] values\n"},
    {"diagnostic_msgs/DiagnosticArray", "std_msgs/Header header\nDiagnosticStatus[] status\n"},
    {"sensor_msgs/Imu",
     "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
     "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
     "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
     "float64[9] linear_acceleration_covariance\n"},
    {"sensor_msgs/JointState",
     "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
     "float64[] effort\n"},
    {"sensor_msgs/BatteryState",
     "std_msgs/Header header\nfloat32 voltage\nfloat32 temperature\nfloat32 current\n"
     "float32 charge\nfloat32 capacity\nfloat32 design_capacity\nfloat32 percentage\n"
     "uint8 power_supply_status\nuint8 power_supply_health\nuint8 power_supply_technology\n"
     "bool present\nfloat32[] cell_voltage\nfloat32[] cell_temperature\nstring location\n"
     "string serial_number\n"},
    {"sensor_msgs/FluidPressure",
     "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance\n"},
    {"sensor_msgs/NavSatStatus", "int8 status\nuint16 service\n"},
    {"sensor_msgs/NavSatFix",
     "std_msgs/Header header\nNavSatStatus status\nfloat64 latitude\nfloat64 longitude\n"
     "float64 altitude\nfloat64[9] position_covariance\nuint8 position_covariance_type\n"},
    // MAVROS 2; the RCIn and State of MAVROS 1 since 2018 are alike.
    {"mavros_msgs/RCOut", "std_msgs/Header header\nuint16[] channels\n"},
    {"mavros_msgs/RCIn", "std_msgs/Header header\nuint8 rssi\nuint16[] channels\n"},
    {"mavros_msgs/OverrideRCIn", "uint16[18] channels\n"},
    {"mavros_msgs/State",
     "std_msgs/Header header\nbool connected\nbool armed\nbool guided\nbool manual_input\n"
     "string mode\nuint8 system_status\n"},
    // Velocity logs: apl-ocean-engineering/marine_msgs, paagutie/dvl_msgs (Water Linked A50 under
    // ROS 2), waterlinked_a50_ros_driver, UUV Simulator and Plankton.
    {"marine_acoustic_msgs/Dvl",
     "std_msgs/Header header\nuint8 velocity_mode\nuint8 dvl_type\n"
     "geometry_msgs/Vector3 velocity\nfloat64[9] velocity_covar\nfloat64 altitude\n"
     "float64 course_gnd\nfloat64 speed_gnd\nuint8 num_good_beams\nfloat32 sound_speed\n"
     "bool beam_ranges_valid\nbool beam_velocities_valid\n"
     "geometry_msgs/Vector3[4] beam_unit_vec\nfloat64[4] range\nfloat32[4] range_covar\n"
     "float32[4] beam_quality\nfloat32[4] beam_velocity\nfloat32[4] beam_velocity_covar\n"},
    {"dvl_msgs/DVLBeam",
     "int64 id\nfloat64 velocity\nfloat64 distance\nfloat64 rssi\nfloat64 nsd\nbool valid\n"},
    {"dvl_msgs/DVL",
     "std_msgs/Header header\nfloat64 time\ngeometry_msgs/Vector3 velocity\nfloat64 fom\n"
     "float64[] covariance\nfloat64 altitude\nDVLBeam[] beams\nbool velocity_valid\n"
     "int64 status\nint64 time_of_validity\nint64 time_of_transmission\nstring form\n"},
    {"waterlinked_a50_ros_driver/DVLBeam",
     "int64 id\nfloat64 velocity\nfloat64 distance\nfloat64 rssi\nfloat64 nsd\nbool valid\n"},
    {"waterlinked_a50_ros_driver/DVL",
     "std_msgs/Header header\nfloat64 time\ngeometry_msgs/Vector3 velocity\nfloat64 fom\n"
     "float64 altitude\nDVLBeam[] beams\nbool velocity_valid\nint64 status\nstring form\n"},
    {"uuv_sensor_ros_plugins_msgs/DVLBeam",
     "float64 range\nfloat64 range_covariance\nfloat64 velocity\nfloat64 velocity_covariance\n"
     "geometry_msgs/PoseStamped pose\n"},
    {"uuv_sensor_ros_plugins_msgs/DVL",
     "std_msgs/Header header\ngeometry_msgs/Vector3 velocity\nfloat64[9] velocity_covariance\n"
     "float64 altitude\nDVLBeam[] beams\n"},
});

}  // namespace

std::string_view built_in_definition(const std::string& short_name, MessageDialect dialect) {
  // What ROS 1 has otherwise.
  static const std::map<std::string, std::string_view, std::less<>> kOfRos1{
      {"builtin_interfaces/Time", "uint32 sec\nuint32 nanosec\n"},
      {"builtin_interfaces/Duration", "int32 sec\nint32 nanosec\n"},
      {"std_msgs/Header", "uint32 seq\ntime stamp\nstring frame_id\n"},
  };
  if (const auto found = kOfRos1.find(short_name);
      dialect == MessageDialect::ros1 && found != kOfRos1.end()) {
    return found->second;
  }
  const auto* const found =
      std::ranges::find(kDefinitions, short_name, &decltype(kDefinitions)::value_type::first);
  return found == kDefinitions.end() ? std::string_view() : found->second;
}

}  // namespace kelpie::bag
