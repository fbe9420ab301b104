// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "bag/message_text.hpp"

namespace kelpie::bag {

// The layouts of ROS 2's common_interfaces and rcl_interfaces, unchanged from Foxy to Jazzy; and
// what of them ROS 1 has otherwise.
std::string_view built_in_definition(const std::string& short_name, MessageDialect dialect) {
  static const std::map<std::string, std::string_view, std::less<>> kOfRos1{
      {"builtin_interfaces/Time", "uint32 sec\nuint32 nanosec\n"},
      {"builtin_interfaces/Duration", "int32 sec\nint32 nanosec\n"},
      {"std_msgs/Header", "uint32 seq\ntime stamp\nstring frame_id\n"},
  };
  if (const auto found = kOfRos1.find(short_name);
      dialect == MessageDialect::ros1 && found != kOfRos1.end()) {
    return found->second;
  }
  static const std::map<std::string, std::string_view, std::less<>> kDefinitions{
      {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
      {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
      {"std_msgs/Empty", "\n"},
      {"std_msgs/Bool", "bool data\n"},
      {"std_msgs/Float64", "float64 data\n"},
      {"std_msgs/String", "string data\n"},
      {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
      {"std_msgs/MultiArrayDimension", "string label\nuint32 size\nuint32 stride\n"},
      {"std_msgs/MultiArrayLayout", "MultiArrayDimension[] dim\nuint32 data_offset\n"},
      {"std_msgs/Float64MultiArray", "MultiArrayLayout layout\nfloat64[] data\n"},
      {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
      {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
      {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
      {"geometry_msgs/Pose", "Point position\nQuaternion orientation\n"},
      {"geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance\n"},
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
  };
  const auto found = kDefinitions.find(short_name);
  return found == kDefinitions.end() ? std::string_view() : found->second;
}

}  // namespace kelpie::bag
