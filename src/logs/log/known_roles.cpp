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
using Kind = CommandWords::Kind;

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

constexpr std::array kCommandWords = std::to_array<CommandWords>({
    {"thruster# thrusters thrust# thr# motor# motors rpm# rps# pwm# servo# prop# propeller# "
     "throttle# esc# actuator# actuators th# n# m#",
     Kind::thrust, 1},
    {"cmd# command# commands control#", Kind::thrust, 1, {}, true},
    {"tau# taux tauy taun", Kind::wrench, 2},
    {"rudder# fin# fins elevator# delta# azimuth# az# steering# helm# tiller# wheel#", Kind::angle,
     1},
    {"u_speed", Kind::thrust, 1, kLetters},
    {"u_heading", Kind::angle, 1, kLetters},
});

// Names that are no commands. In small letters; "#" stands for digits.
struct OtherName {
  enum class Where { whole, word, last, command };  // command: a word that excludes commands alone
  Where where;
  std::string_view names;
  std::string_view why;
};
using Where = OtherName::Where;
constexpr std::string_view kMeasurement = "a measurement, no command; --inputs takes it";
constexpr std::string_view kAcceleration = "an acceleration; --inputs takes it";
constexpr std::string_view kDemand = "a demand to a controller, no command; --inputs takes it";
constexpr std::string_view kDemandWords = "reference# setpoint# desired wanted ref#";
constexpr std::array kOtherNames = std::to_array<OtherName>({
    {Where::whole, "run index idx row seq count frame window trial sample iteration", "a counter"},
    {Where::last, "step", "a counter"},
    // What somebody knows of a row, and the vehicle does not.
    {Where::whole,
     "held held_out fold label condition fault faults class phase mission mode scenario",
     "a label"},
    {Where::last, "state mode", "a label"},
    // Where or when, which no dynamics depend on.
    {Where::whole,
     "depth lat lon latitude longitude altitude px py pz north east down easting northing pos_x "
     "pos_y pos_z",
     "a position"},
    // Of the angles heading alone is without effect: roll and pitch restore.
    {Where::whole, "heading psi yaw hdg cog course yaw_deg compass", "a heading"},
    {Where::whole, "volt volts voltage voltage_v current_a amps", "of a battery"},
    {Where::word, "battery batt soc vbat", "of a battery"},
    {Where::whole, "ax ay az accx accy accz", kAcceleration},
    {Where::last, "mps2 ms2", kAcceleration},
    {Where::whole, "power_w sog", kMeasurement},
    {Where::word,
     "imu temp temps temperature# sat sats nsats satellites humidity rssi snr gain gains sigma "
     "vacuum leak cpu hdop pdop vdop salinity conductivity turbidity",
     kMeasurement},
    {Where::word, kDemandWords, kDemand},
    {Where::command,
     "time stamp timestamp secs nsecs sec nanosec seq current voltage covariance mode error err "
     "limit min max status_code fault armed enabled id index count true power",
     "no command by its name"},
});

// Before the axis of an acceleration.
constexpr std::array kAccelerationWords =
    std::to_array<std::string_view>({"acc", "accel", "acceleration"});

constexpr std::array kAffixes = std::to_array<KnownAffix>({
    {"true truth gt tv", "the true {}, which no vehicle knows"},
    {"next prev previous last lagged", "{} of another row"},
    {"act actual measured meas feedback fb", "what {} is measured to be"},
});

// Words that tell one actuator from another.
constexpr std::string_view kSides =
    "left right port starboard stbd sb ps fore aft front back rear bow stern top bottom upper "
    "lower vertical horizontal vert horiz lateral center centre mid main inner outer fl fr rl rr "
    "bl br out raw";

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
    {"{roll,pitch,yaw}_rate", 3},
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

// Last words of a name that are its unit. Not those that are words of their own: s, v, a, rpm.
struct UnitWords {
  std::string_view words;
  const char* unit;
};
constexpr std::array kUnitWords = std::to_array<UnitWords>({
    {"mps m_s", "m/s"},
    {"cmps cm_s", "cm/s"},
    {"mmps mm_s", "mm/s"},
    {"kn kt kts knots", "knots"},
    {"kmh kph", "km/h"},
    {"dps degps deg_s", "deg/s"},
    {"radps rad_s", "rad/s"},
    {"m", "m"},
    {"cm", "cm"},
    {"mm", "mm"},
    {"deg", "deg"},
    {"rad", "rad"},
});

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

std::span<const CommandWords> known_command_words() {
  return kCommandWords;
}

bool is_among_words(std::string_view words, std::string_view word) {
  const std::string_view stem = word.substr(0, word.find_last_not_of("0123456789") + 1);
  return std::ranges::any_of(split_text(std::string(words), ' '), [&](const std::string& known) {
    return word == known || (known.ends_with('#') && known.substr(0, known.size() - 1) == stem);
  });
}

bool is_command_word(std::string_view word) {
  return std::ranges::any_of(
      kCommandWords, [&](const CommandWords& known) { return is_among_words(known.words, word); });
}

bool is_demand_word(std::string_view word) {
  return is_among_words(kDemandWords, word);
}

std::span<const KnownAffix> known_affixes() {
  return kAffixes;
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

namespace {

bool is_of_velocity(const std::string& unit) {
  return unit.find('/') != std::string::npos || unit == "knots";
}

// Takes the words of a unit off the end. Returns the unit; "" without one.
std::string take_unit(std::vector<std::string>& words) {
  for (const std::size_t count : {std::size_t{2}, std::size_t{1}}) {
    if (words.size() <= count) {
      continue;
    }
    const auto first = words.end() - static_cast<std::ptrdiff_t>(count);
    const std::string last = join_text(std::vector(first, words.end()), "_");
    for (const UnitWords& known : kUnitWords) {
      if (const auto all = split_text(std::string(known.words), ' ');
          std::ranges::find(all, last) != all.end()) {
        words.erase(first, words.end());
        return known.unit;
      }
    }
  }
  return "";
}

std::vector<std::string> all_words_of(std::string_view name) {
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

}  // namespace

std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words = all_words_of(name);
  take_unit(words);
  return words;
}

std::string unit_in_name(std::string_view name) {
  std::vector<std::string> words = all_words_of(name);
  return velocity_by_name(name) || measured_pose_part(name) ? take_unit(words) : "";
}

namespace {

// By more than the letter of its number, "n1".
bool is_actuator(const std::string& word) {
  return word.find_last_not_of("0123456789") > 0 &&
         std::ranges::any_of(kCommandWords, [&](const CommandWords& known) {
           return !known.is_weak && is_among_words(known.words, word);
         });
}

// A side, a number, a letter, a field of a thruster's message.
bool tells_which(const std::string& word) {
  return is_digit(word) || word.size() == 1 || is_among_words(kSides, word) ||
         std::ranges::find(kCommandFields, word) != kCommandFields.end();
}

// The words of the last part of a path that tells more than which actuator or field.
std::vector<std::string> last_part(std::string_view name) {
  for (std::string_view rest = name;;) {
    const std::size_t cut = rest.find_last_of("/:.");
    std::vector<std::string> words =
        words_of(cut == std::string_view::npos ? rest : rest.substr(cut + 1));
    if (cut == std::string_view::npos || !std::ranges::all_of(words, tells_which)) {
      return words;
    }
    rest = rest.substr(0, cut);
  }
}

}  // namespace

std::string why_no_input(std::string_view name) {
  const std::vector<std::string> words = words_of(name);
  const std::string whole = join_text(words, "_");
  const auto is_of = [&](const OtherName& known) {
    const auto is_one = [&](const std::string& word) { return is_among_words(known.names, word); };
    return known.where == Where::whole  ? is_one(whole)
           : known.where == Where::word ? std::ranges::any_of(words, is_one)
           : known.where == Where::last ? words.size() > 1 && is_one(words.back())
                                        : false;
  };
  for (const OtherName& known : kOtherNames) {
    if (is_of(known) && !(known.why == kDemand && std::ranges::any_of(words, is_actuator))) {
      return std::string(known.why);
    }
  }
  const bool is_of_axis = words.size() > 1 && words.back().size() == 1 && words.back() >= "x" &&
                          words.back() <= "z" &&
                          std::ranges::count(kAccelerationWords, words[words.size() - 2]) > 0;
  // T_motor, I_motor; m_depth of a Slocum glider, whose m_ stands for measured.
  const bool is_of_motor =
      (name.starts_with("T_") || name.starts_with("I_")) && std::ranges::any_of(words, is_actuator);
  const bool is_of_slocum = words.size() > 1 && words.front() == "m" && !tells_which(words[1]);
  return std::string(is_of_axis                    ? kAcceleration
                     : is_of_motor || is_of_slocum ? kMeasurement
                                                   : std::string_view());
}

std::string why_no_command(std::string_view name) {
  if (std::string why = why_no_input(name); !why.empty()) {
    return why;
  }
  const std::vector<std::string> words = words_of(name);
  const auto excludes = [&](const OtherName& known) {
    return known.where == Where::command &&
           std::ranges::any_of(
               words, [&](const std::string& word) { return is_among_words(known.names, word); });
  };
  if (std::ranges::any_of(kOtherNames, excludes)) {
    return "no command by its name";
  }
  std::vector<std::string> last = last_part(name);
  last.push_back(join_text(last, "_"));  // u_heading
  const bool is_of_slocum = words.size() > 1 && words.front() == "c";
  const auto is_command = [&](const std::string& word) {
    return is_of_slocum || is_command_word(word);
  };
  const bool has_command = std::ranges::any_of(last, is_command);
  last.pop_back();
  return has_command || std::ranges::all_of(last, tells_which) ? "" : "no command by its last word";
}

std::optional<Validity> validity_by_name(std::string_view name) {
  constexpr std::string_view kAbout =
      "velocity velocities vel dvl bt btm bottom track is has flag u v w speed data";
  constexpr std::string_view kWhere1 = "valid validity lock locked";
  constexpr std::string_view kWhere0 = "invalid lost unlocked";
  constexpr std::string_view kMerit = "fom merit";
  std::optional<Validity> found;
  for (const std::string& word : words_of(name)) {
    if (is_among_words(kWhere1, word)) {
      found = Validity::where_1;
    } else if (is_among_words(kWhere0, word)) {
      found = Validity::where_0;
    } else if (is_among_words(kMerit, word)) {
      found = Validity::merit;
    } else if (!is_among_words(kAbout, word) && word != "figure" && word != "of") {
      return std::nullopt;
    }
  }
  return found;
}

std::optional<std::pair<std::string, double>> validity_of_message(std::string_view type) {
  constexpr std::array kFields = std::to_array<std::pair<std::string_view, const char*>>({
      {"dvl_msgs/DVL", "velocity_valid"},
      {"waterlinked_a50_ros_driver/DVL", "velocity_valid"},
  });
  constexpr double kLeastBeams = 3.0;  // that tell three velocities
  if (type == "marine_acoustic_msgs/Dvl") {
    return std::pair("num_good_beams", kLeastBeams);
  }
  const auto* const found = std::ranges::find(kFields, type, &decltype(kFields)::value_type::first);
  return found == kFields.end() ? std::nullopt : std::optional(std::pair(found->second, 1.0));
}

bool names_fin(std::string_view column) {
  return std::ranges::any_of(words_of(column), [](const std::string& word) {
    const std::size_t letters = word.find_last_not_of("0123456789") + 1;
    return std::ranges::find(kFinWords, std::string_view(word).substr(0, letters)) !=
           kFinWords.end();
  });
}

std::optional<std::size_t> velocity_by_name(std::string_view name) {
  std::vector<std::string> all = all_words_of(name);
  const std::string unit = take_unit(all);
  if (!unit.empty() && !is_of_velocity(unit)) {
    return std::nullopt;
  }
  const std::string words = join_text(all, "_");
  static const std::map<std::string, std::size_t> kAxes = axes_by_name();
  if (const auto known = kAxes.find(words + (unit.empty() ? "" : "_rate")); known != kAxes.end()) {
    return known->second;
  }
  if (const auto known = kAxes.find(words); known != kAxes.end()) {
    return known->second;
  }
  const std::optional<std::size_t> axis = velocity_axis(words);
  return axis ? axis : velocity_axis(name);
}

std::optional<std::string> pose_part_by_name(std::string_view name) {
  std::vector<std::string> words = all_words_of(name.substr(name.rfind(':') + 1));
  if (is_of_velocity(take_unit(words))) {
    return std::nullopt;
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

std::optional<std::string> measured_pose_part(std::string_view name) {
  constexpr std::string_view kOther =
      "cmd command desired ref target setpoint rate speed vel velocity accel true error covariance";
  const std::vector<std::string> words = words_of(name);
  const bool is_other = std::ranges::any_of(
      words, [&](const std::string& word) { return is_among_words(kOther, word); });
  return is_other ? std::nullopt : pose_part_by_name(name);
}

}  // namespace kelpie::log
