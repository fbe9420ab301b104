// SPDX-License-Identifier: Apache-2.0
// All that is known of the names, types and units that logs of vehicles have.
#include "log/known_roles.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

#include "core/text.hpp"
#include "motion/states.hpp"

namespace kelpie::log {
namespace {

constexpr const char* kRep103 = "twist of the body, x forward, y left, z up (REP 103, REP 105)";
constexpr const char* kTruth =
    "simulators give the truth's twist along the axes of the world, as UUV Simulator does";
constexpr const char* kDvl = "a DVL: its own axes, and where it is mounted, aren't told";
constexpr const char* kEkf = "the autopilot's estimate, of the world: turned by the attitude";
constexpr const char* kDelta =
    "ways between two measurements of a DVL or a camera over their times, axes of the body";
constexpr const char* kBody = "axes of the body";
constexpr const char* kRates = "rates about the axes of the body";
constexpr const char* kAttitude = "the autopilot's attitude";
constexpr const char* kMotors =
    "what the motors are sent; 1500 µs is no thrust where it is a width";
constexpr const char* kBattery = "a column beside; no input unless you name it one";
constexpr const char* kSticks = "the pilot's sticks: a controller lies between them and the motors";
constexpr const char* kWish = "what a controller is asked for: it lies between this and the motors";

using enum Part;
using Kind = KnownWord::Kind;

constexpr std::array kMessages = std::to_array<KnownMessage>({
    // ROS
    {"nav_msgs/Odometry", "pose_gt", velocity, "twist.twist.linear.{x,y,z}", "ENU", 3, kTruth},
    {"nav_msgs/Odometry", "pose_gt", rates, "twist.twist.angular.{x,y,z}", "", 3, kTruth},
    {"nav_msgs/Odometry", "", velocity, "twist.twist.linear.{x,y,z}", "FLU", 1, kRep103},
    {"nav_msgs/Odometry", "", rates, "twist.twist.angular.{x,y,z}", "FLU", 1, kRep103},
    {"nav_msgs/Odometry", "", quaternion, "pose.pose.orientation.{w,x,y,z}", "ENU", 1, kRep103},
    {"geometry_msgs/TwistStamped", "cmd", commands, "twist.{linear,angular}.{x,y,z}", "", 3, kWish},
    {"geometry_msgs/Twist", "cmd", commands, "{linear,angular}.{x,y,z}", "", 3, kWish},
    {"geometry_msgs/TwistStamped", "velocity_local", velocity, "twist.linear.{x,y,z}", "ENU", 3,
     "mavros: along the axes of the world"},
    {"geometry_msgs/TwistStamped", "", velocity, "twist.linear.{x,y,z}", "FLU", 2, kRep103},
    {"geometry_msgs/TwistStamped", "", rates, "twist.angular.{x,y,z}", "FLU", 2, kRep103},
    {"geometry_msgs/TwistWithCovarianceStamped", "", velocity, "twist.twist.linear.{x,y,z}", "FLU",
     2, kRep103},
    {"geometry_msgs/TwistWithCovarianceStamped", "", rates, "twist.twist.angular.{x,y,z}", "FLU", 2,
     kRep103},
    {"geometry_msgs/Twist", "", velocity, "linear.{x,y,z}", "FLU", 3, kRep103},
    {"geometry_msgs/Twist", "", rates, "angular.{x,y,z}", "FLU", 3, kRep103},
    {"marine_acoustic_msgs/Dvl", "", velocity, "velocity.{x,y,z}", "", 2, kDvl},
    {"dvl_msgs/DVL", "", velocity, "velocity.{x,y,z}", "", 2, kDvl},
    {"waterlinked_a50_ros_driver/DVL", "", velocity, "velocity.{x,y,z}", "", 2, kDvl},
    {"uuv_sensor_ros_plugins_msgs/DVL", "", velocity, "velocity.{x,y,z}", "", 2, kDvl},
    {"sensor_msgs/Imu", "", rates, "angular_velocity.{x,y,z}", "FLU", 2, kRates},
    {"sensor_msgs/Imu", "", quaternion, "orientation.{w,x,y,z}", "ENU", 2, "the IMU's attitude"},
    {"sensor_msgs/BatteryState", "", voltage, "voltage", "", 1, kBattery},
    {"mavros_msgs/RCOut", "", commands, "channels[0..7]", "", 1, kMotors},
    {"mavros_msgs/RCIn", "", commands, "channels[0..7]", "", 3, kSticks},
    {"mavros_msgs/OverrideRCIn", "", commands, "channels[0..7]", "", 3, kSticks},
    {"mavros_msgs/ManualControl", "", commands, "{x,y,z,r}", "", 3, kSticks},
    {"sensor_msgs/JointState", "thrust", commands, "velocity[0..15]", "", 1, "speeds of rotors"},
    {"std_msgs/Float64MultiArray", "thrust", commands, "data[0..15]", "", 1, "thrusters"},
    {"std_msgs/Float32MultiArray", "thrust", commands, "data[0..15]", "", 1, "thrusters"},
    {"heron_msgs/Drive", "", commands, "{left,right}", "", 1, "the thrusters of a Heron"},
    {"geometry_msgs/WrenchStamped", "", commands, "wrench.{force,torque}.{x,y,z}", "", 3, kWish},
    {"geometry_msgs/Wrench", "", commands, "{force,torque}.{x,y,z}", "", 3, kWish},
    // MAVLink
    {"ODOMETRY", "", velocity, "{vx,vy,vz}", "FRD", 1, kBody},
    {"ODOMETRY", "", rates, "{rollspeed,pitchspeed,yawspeed}", "FRD", 1, kRates},
    {"VISION_POSITION_DELTA", "", velocity, "position_delta[0..2]/time_delta_usec", "FRD", 2,
     kDelta},
    {"LOCAL_POSITION_NED", "", velocity, "{vx,vy,vz}", "NED", 3, kEkf},
    {"GLOBAL_POSITION_INT", "", velocity, "{vx,vy,vz}", "NED", 4, kEkf},
    {"ATTITUDE", "", rates, "{rollspeed,pitchspeed,yawspeed}", "FRD", 1, kRates},
    {"ATTITUDE", "", angles, "{roll,pitch,yaw}", "NED", 1, kAttitude},
    {"ATTITUDE_QUATERNION", "", rates, "{rollspeed,pitchspeed,yawspeed}", "FRD", 2, kRates},
    {"ATTITUDE_QUATERNION", "", quaternion, "q{1..4}", "NED", 2, kAttitude},
    {"SERVO_OUTPUT_RAW", "", commands, "servo{1..16}_raw", "", 1, kMotors},
    {"SYS_STATUS", "", voltage, "voltage_battery", "", 1, kBattery},
    {"MANUAL_CONTROL", "", commands, "{x,y,z,r}", "", 3, kSticks},
    {"RC_CHANNELS", "", commands, "chan{1..8}_raw", "", 4, kSticks},
    // ArduPilot's DataFlash
    {"VISO", "", velocity, "{PosDX,PosDY,PosDZ}/dt", "FRD", 1, kDelta},
    {"XKF1", "", velocity, "{VN,VE,VD}", "NED", 2, kEkf},
    {"XKF1", "", angles, "{Roll,Pitch,Yaw}", "NED", 1, kAttitude},
    {"NKF1", "", velocity, "{VN,VE,VD}", "NED", 3, kEkf},
    {"NKF1", "", angles, "{Roll,Pitch,Yaw}", "NED", 2, kAttitude},
    {"ATT", "", angles, "{Roll,Pitch,Yaw}", "NED", 3, kAttitude},
    {"RATE", "", rates, "{R,P,Y}", "FRD", 1, kRates},
    {"IMU", "", rates, "{GyrX,GyrY,GyrZ}", "FRD", 2, kRates},
    {"RCOU", "", commands, "C{1..14}", "", 1, kMotors},
    {"BAT", "", voltage, "Volt", "", 1, kBattery},
    {"RCIN", "", commands, "C{1..8}", "", 3, kSticks},
    // PX4's ULog
    {"vehicle_local_position", "", velocity, "{vx,vy,vz}", "NED", 1, kEkf},
    {"vehicle_odometry", "", velocity, "velocity[0..2]", "NED", 2, kEkf},
    {"vehicle_attitude", "", quaternion, "q[0..3]", "NED", 1, kAttitude},
    {"vehicle_attitude", "", rates, "{rollspeed,pitchspeed,yawspeed}", "FRD", 2, kRates},
    {"vehicle_angular_velocity", "", rates, "xyz[0..2]", "FRD", 1, kRates},
    {"sensor_combined", "", rates, "gyro_rad[0..2]", "FRD", 3, kRates},
    {"actuator_motors", "", commands, "control[0..11]", "", 1, kMotors},
    {"actuator_outputs", "", commands, "output[0..7]", "", 2, kMotors},
    {"actuator_controls_0", "", commands, "control[0..7]", "", 3,
     "what the mixer is given: torques and thrusts asked for"},
    {"manual_control_setpoint", "", commands, "{x,y,z,r}", "", 4, kSticks},
});

constexpr const char* kLetters =
    "the controller's output, by the letters of control theory: r, e, u, y";

// Words with blanks between them.
struct CommandWords {
  std::string_view words;
  KnownWord::Kind kind;
  int rank;
  std::string_view why = {};
};
constexpr std::array kCommandWords = std::to_array<CommandWords>({
    {"thruster# thrusters thrust# thr# motor# motors rpm# rps# pwm# servo# prop# propeller# "
     "throttle# esc# actuator# actuators th# n# m# cmd# command# commands control#",
     Kind::thrust, 1},
    {"tau# taux tauy taun", Kind::wrench, 2},
    {"rudder# fin# fins elevator# delta# azimuth# az# steering# helm# tiller# wheel#", Kind::angle,
     1},
    {"u_speed", Kind::thrust, 1, kLetters},
    {"u_heading", Kind::angle, 1, kLetters},
});

constexpr std::array kOtherWords = std::to_array<std::string_view>(
    {"time",  "stamp",   "timestamp",  "secs",        "nsecs", "sec",     "nanosec",
     "seq",   "current", "voltage",    "temperature", "temp",  "battery", "covariance",
     "mode",  "error",   "err",        "limit",       "min",   "max",     "status_code",
     "fault", "armed",   "enabled",    "id",          "index", "count",   "true",
     "power", "sats",    "satellites", "imu"});

constexpr std::array kCommandFields = std::to_array<std::string_view>(
    {"cmd", "command", "input", "data", "value", "speed", "rpm", "rps", "velocity", "omega", "pwm",
     "thrust", "force", "effort", "throttle", "angle", "setpoint"});

// Words joined by "_", and the axis of the first of the names; the next names are the next axes.
struct VelocityNames {
  std::string_view names;
  std::size_t first_axis;
};
constexpr std::array kVelocityNames = std::to_array<VelocityNames>({
    {"vel_{x,y,z}", 0},
    {"vel{x,y,z}", 0},
    {"velocity_{x,y,z}", 0},
    {"{x,y,z}_velocity", 0},
    {"{x,y,z}_vel", 0},
    {"v{x,y,z}_body", 0},
    {"body_v{x,y,z}", 0},
    {"linear_{x,y,z}", 0},
    {"angular_{x,y,z}", 3},
    {"w{x,y,z}", 3},
    {"w_{x,y,z}", 3},
    {"omega_{x,y,z}", 3},
    {"gyro_{x,y,z}", 3},
    {"{roll,pitch,yaw}speed", 3},
    {"{roll,pitch,yaw}_speed", 3},
    {"forward_speed", 0},
    {"forward_velocity", 0},
    {"heading_rate", 5},
    {"linear_velocity", 0},
    {"angular_velocity", 5},
    {"y_speed", 0},
    {"rate_of_turn", 5},
    {"rot", 5},
    {"nav_speed", 0},
});

constexpr std::array kFinWords = std::to_array<std::string_view>(
    {"rudder", "rudders", "fin", "fins", "elevator", "elevators", "plane", "planes", "sternplane",
     "sternplanes", "bowplane", "bowplanes", "aileron", "ailerons", "flap", "flaps", "delta"});

// Parts of a pose, with the words for each.
struct PoseWords {
  std::string_view part;
  std::string_view words;
};
constexpr std::array kPoseWords = std::to_array<PoseWords>({
    {"x", "x px pos_x position_x pose_x north northing"},
    {"y", "y py pos_y position_y pose_y east easting"},
    {"z", "z pz pos_z position_z pose_z depth down"},
    {"roll", "roll phi"},
    {"pitch", "pitch theta"},
    {"yaw", "yaw psi heading hdg compass"},
    {"qw", "qw orientation_w"},
    {"qx", "qx orientation_x"},
    {"qy", "qy orientation_y"},
    {"qz", "qz orientation_z"},
});

constexpr std::array kTimes = std::to_array<std::string_view>(
    {"timestamp",    "time_s",   "t_s",          "times",        "secs",        "seconds",
     "sec",          "elapsed",  "elapsed_time", "elapsed_s",    "time_ms",     "t_ms",
     "timestamp_ms", "time_us",  "t_us",         "timestamp_us", "rosbag_time", "rosbagtimestamp",
     "clock",        "date",     "datetime",     "unix_time",    "epoch",       "utc",
     "utc_time",     "tow",      "gps_tow",      "gps_time",     "gps_seconds", "m_present_time",
     "time_boot_ms", "time_usec"});

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

bool is_digit(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

// What stands between brackets: "x,y,z", "1..8" or, of an index, "0..3".
std::vector<std::string> choices(std::string_view text) {
  const std::size_t dots = text.find("..");
  if (dots == std::string_view::npos) {
    return split_text(text, ',');
  }
  std::vector<std::string> numbers;
  const int last = std::stoi(std::string(text.substr(dots + 2)));
  for (int number = std::stoi(std::string(text.substr(0, dots))); number <= last; ++number) {
    numbers.push_back(std::to_string(number));
  }
  return numbers;
}

std::map<std::string, std::size_t> axes_by_name() {
  std::map<std::string, std::size_t> axes;
  for (const VelocityNames& known : kVelocityNames) {
    std::size_t axis = known.first_axis;
    for (const std::string& name : expanded(known.names)) {
      axes.emplace(name, axis++);
    }
  }
  return axes;
}

}  // namespace

std::span<const KnownMessage> known_messages() {
  return kMessages;
}

const std::vector<KnownWord>& known_command_words() {
  static const std::vector<KnownWord> all = [] {
    std::vector<KnownWord> words;
    for (const CommandWords& known : kCommandWords) {
      for (const std::string& word : split_text(known.words, ' ')) {
        words.push_back({word, known.kind, known.rank, known.why});
      }
    }
    return words;
  }();
  return all;
}

std::span<const std::string_view> known_other_words() {
  return kOtherWords;
}

std::span<const std::string_view> known_command_fields() {
  return kCommandFields;
}

std::span<const std::string_view> known_times() {
  return kTimes;
}

std::vector<std::string> expanded(std::string_view fields) {
  const std::size_t begin = fields.find_first_of("{[");
  if (begin == std::string_view::npos) {
    return {std::string(fields)};
  }
  const bool is_index = fields[begin] == '[';
  const std::size_t end = fields.find(is_index ? ']' : '}', begin);
  std::vector<std::string> all;
  for (const std::string& choice : choices(fields.substr(begin + 1, end - begin - 1))) {
    for (const std::string& rest : expanded(fields.substr(end + 1))) {
      std::string one(fields.substr(0, begin));
      one += is_index ? "[" + choice + "]" : choice;
      all.push_back(one + rest);
    }
  }
  return all;
}

std::vector<std::string> words_of(std::string_view name) {
  name = trimmed(name);
  if (const std::size_t bracket = name.find_last_of("[(");
      bracket != std::string_view::npos && bracket > 0 && !is_digit(name.substr(bracket + 1, 1))) {
    name = name.substr(0, bracket);
  }
  std::vector<std::string> words(1);
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    const bool is_of_word = is_letter(name[i]) || is_digit(name.substr(i, 1)) || c >= 0x80;
    const bool begins =
        std::isupper(c) != 0 && i > 0 && std::islower(static_cast<unsigned char>(name[i - 1])) != 0;
    if ((!is_of_word || begins) && !words.back().empty()) {
      words.emplace_back();
    }
    if (is_of_word) {
      words.back() += static_cast<char>(std::tolower(c));
    }
  }
  if (words.back().empty()) {
    words.pop_back();
  }
  return words;
}

bool names_fin(std::string_view column) {
  return std::ranges::any_of(words_of(column), [](const std::string& word) {
    const std::size_t letters = word.find_last_not_of("0123456789") + 1;
    return std::ranges::find(kFinWords, std::string_view(word).substr(0, letters)) !=
           kFinWords.end();
  });
}

std::optional<std::size_t> velocity_by_name(std::string_view name) {
  const std::string words = join_text(words_of(name), "_");
  static const std::map<std::string, std::size_t> kAxes = axes_by_name();
  if (const auto known = kAxes.find(words); known != kAxes.end()) {
    return known->second;
  }
  const std::optional<std::size_t> axis = velocity_axis(words);
  return axis ? axis : velocity_axis(name);
}

std::optional<std::string> pose_part_by_name(std::string_view name) {
  std::vector<std::string> words = words_of(name.substr(name.rfind(':') + 1));
  if (!words.empty() && (words.back() == "deg" || words.back() == "rad" || words.back() == "m")) {
    words.pop_back();
  }
  for (const std::size_t count : {std::size_t{2}, std::size_t{1}}) {
    if (words.size() < count) {
      continue;
    }
    const std::string last =
        join_text(std::vector(words.end() - static_cast<std::ptrdiff_t>(count), words.end()), "_");
    for (const PoseWords& known : kPoseWords) {
      const std::vector<std::string> all = split_text(std::string(known.words), ' ');
      if (std::ranges::find(all, last) != all.end()) {
        return std::string(known.part);
      }
    }
  }
  return std::nullopt;
}

}  // namespace kelpie::log
