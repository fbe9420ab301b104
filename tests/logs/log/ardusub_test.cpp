// SPDX-License-Identifier: Apache-2.0
#include "log/ardusub.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bag/ardusub_drive.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "log/read_log.hpp"
#include "support.hpp"

namespace kelpie::ardusub_test {
namespace {

using testing::ArdusubDrive;

class Ardusub : public ::testing::Test {
 protected:
  Ardusub() {
    testing::write_text(folder_ / "drive.tlog", ArdusubDrive::tlog().text());
    testing::write_text(folder_ / "drive.BIN", ArdusubDrive::bin());
  }

  log::Log read(const char* name, const std::string& config = {}) const {
    if (!config.empty()) {
      testing::write_text(folder_ / "c.toml", config);
    }
    const log::LogConfig how =
        config.empty() ? log::LogConfig{} : log::read_log_config(folder_ / "c.toml");
    return log::read_log({.path = (folder_ / name).string()}, how, how.roles);
  }

  testing::TemporaryFolder folder_;
};

const std::vector<double>& column(const log::Log& log, const std::string& name) {
  return log.table.columns[log.table.find(name)];
}

TEST(ArdusubParameters, TellMotorsTheirOrderAndDirections) {
  const std::vector<log::MotorActuator> motors = log::motor_outputs({{"SERVO1_FUNCTION", 40},
                                                                     {"SERVO2_FUNCTION", 33},
                                                                     {"SERVO3_FUNCTION", 0},
                                                                     {"SERVO14_FUNCTION", 82},
                                                                     {"SERVO16_FUNCTION", 7},
                                                                     {"MOT_8_DIRECTION", -1}});
  ASSERT_EQ(motors.size(), 3U);
  EXPECT_EQ(motors[0].output, 2U);
  EXPECT_EQ(motors[0].motor, 1U);
  EXPECT_EQ(motors[1].output, 1U);
  EXPECT_EQ(motors[1].motor, 8U);
  EXPECT_EQ(motors[1].direction, -1.0);
  EXPECT_EQ(motors[2].output, 14U);
  EXPECT_EQ(motors[2].motor, 9U);
  EXPECT_TRUE(log::motor_outputs({{"SERVO1_FUNCTION", NAN}}).empty());
  EXPECT_EQ(log::other_outputs_text({{"SERVO9_FUNCTION", 182}, {"SERVO10_FUNCTION", 999}}),
            "9 (lights 2), 10 (function 999)");
  EXPECT_NE(log::sub_frame_name({{"FRAME_CONFIG", 2}}).find("BlueROV2 Heavy"), std::string::npos);
  EXPECT_EQ(log::sub_frame_name({{"FRAME_CONFIG", 99}}), "");
}

TEST_F(Ardusub, RowsAreThoseOfTheDriveFromBothRecordings) {
  for (const char* const name : {"drive.tlog", "drive.BIN"}) {
    const log::Log log = read(name);
    const log::Dataset data = log.dataset();
    EXPECT_EQ(join_text(data.input_names, ","), "u,v,w,p,q,r,phi,theta,m1,m2,m3,m4,m5,m6") << name;
    EXPECT_EQ(join_text(data.target_names, ","), "udot,vdot,wdot,pdot,qdot,rdot") << name;
    EXPECT_GT(log.disarmed, 100U) << name;
    const std::vector<double>& times = column(log, "t");
    ASSERT_GT(times.size(), 980U) << name;
    ASSERT_LT(times.size(), 1005U) << name;
    for (std::size_t row = 10; row + 10 < times.size(); ++row) {
      const double t = ArdusubDrive::kArmed_s + times[row];
      const auto [u, v, w] = ArdusubDrive::velocity(t);
      EXPECT_NEAR(column(log, "u")[row], u, 2e-3) << name << " " << t;
      EXPECT_NEAR(column(log, "v")[row], v, 2e-3) << name << " " << t;
      EXPECT_NEAR(column(log, "w")[row], w, 2e-3) << name << " " << t;
      EXPECT_NEAR(column(log, "udot")[row], 0.35 * std::cos(0.7 * t), 2e-2) << name << " " << t;
      EXPECT_NEAR(column(log, "r")[row], ArdusubDrive::rates(t)[2], 1e-3) << name << " " << t;
      EXPECT_NEAR(column(log, "phi")[row], ArdusubDrive::angles(t)[0], 1e-3) << name << " " << t;
      EXPECT_NEAR(column(log, "m1")[row], ArdusubDrive::pulse(t, 2), 1e-9) << name << " " << t;
      EXPECT_NEAR(column(log, "m2")[row], 3000.0 - ArdusubDrive::pulse(t, 1), 1e-9) << name;
    }
  }
}

TEST_F(Ardusub, BothRecordingsGiveTheSameRows) {
  const log::Log ground = read("drive.tlog");
  const log::Log board = read("drive.BIN");
  const std::size_t rows = std::min(ground.table.rows(), board.table.rows());
  // The voltage, twice a second, ends the rows of the .BIN.
  EXPECT_LE(std::max(ground.table.rows(), board.table.rows()) - rows, 5U);
  for (const char* const name :
       {"t", "u", "v", "w", "p", "q", "r", "phi", "theta", "m1", "m2", "m3", "m4", "m5", "m6"}) {
    for (std::size_t row = 10; row + 10 < rows; ++row) {
      ASSERT_NEAR(column(ground, name)[row], column(board, name)[row], 1e-3) << name << " " << row;
    }
  }
  EXPECT_NEAR(column(board, "voltage")[100], 16.0 - 0.01 * 30.0, 0.01);
}

// Where a DVL's way per time is recorded, this measurement is the velocity, not the filter's.
TEST_F(Ardusub, AVelocityLogsDeltasAreTheVelocities) {
  testing::write_text(folder_ / "dvl.tlog", ArdusubDrive::tlog(true).text());
  testing::write_text(folder_ / "dvl.BIN", ArdusubDrive::bin(true));
  for (const auto& [name, from] :
       {std::pair("dvl.tlog", "VISION_POSITION_DELTA:position_delta[1]/time_delta_usec"),
        std::pair("dvl.BIN", "VISO:PosDY/dt")}) {
    const log::Log log = read(name);
    EXPECT_NE(log.draft->toml().find(from), std::string::npos) << log.draft->toml();
    const log::Dataset data = log.dataset();
    EXPECT_EQ(join_text(data.input_names, ","), "u,v,w,p,q,r,phi,theta,m1,m2,m3,m4,m5,m6") << name;
    const std::vector<double>& times = column(log, "t");
    ASSERT_GT(times.size(), 980U) << name;
    for (std::size_t row = 10; row + 10 < times.size(); ++row) {
      const double t = ArdusubDrive::kArmed_s + times[row];
      const auto [u, v, w] = ArdusubDrive::velocity(t);
      ASSERT_NEAR(column(log, "u")[row], u, 2e-3) << name << " " << t;
      ASSERT_NEAR(column(log, "v")[row], v, 2e-3) << name << " " << t;
      ASSERT_NEAR(column(log, "w")[row], w, 2e-3) << name << " " << t;
      ASSERT_NEAR(column(log, "phi")[row], ArdusubDrive::angles(t)[0], 1e-3) << name << " " << t;
    }
  }
}

// One configuration for every vehicle: the parameters tell what is mirrored.
TEST_F(Ardusub, MotorsAreMirroredAsTheParametersTell) {
  const auto config = [](const std::string& topic, const std::string& more) {
    return "[log]\nrate = 10\nclock = \"header\"\nmirror_motors = true\ninputs = [\"m1\", \"m2\", "
           "\"lights\"]\ntargets = [\"r\"]\n[log.states]\nr = \"" +
           std::string(topic == "RCOU:C" ? "RATE:Y" : "ATTITUDE:yawspeed") +
           "\"\n[log.commands]\n" + "m1 = \"" + topic + "2" + (topic == "RCOU:C" ? "" : "_raw") +
           "\"\nm2 = \"" + topic + "1" + (topic == "RCOU:C" ? "" : "_raw") + "\"\nlights = \"" +
           topic + "9" + (topic == "RCOU:C" ? "" : "_raw") + "\"\n" + more;
  };
  for (const auto& [name, topic] :
       {std::pair("drive.tlog", "SERVO_OUTPUT_RAW:servo"), std::pair("drive.BIN", "RCOU:C")}) {
    const log::Log log = read(name, config(topic, ""));
    const std::vector<double>& times = column(log, "t");
    ASSERT_GT(times.size(), 1300U) << name;
    for (std::size_t row = 300; row < 1100; ++row) {
      const double t = times[row];
      ASSERT_NEAR(column(log, "m1")[row], ArdusubDrive::pulse(t, 2), 1e-9) << name << " " << t;
      ASSERT_NEAR(column(log, "m2")[row], 3000.0 - ArdusubDrive::pulse(t, 1), 1e-9) << name;
      ASSERT_NEAR(column(log, "lights")[row], ArdusubDrive::pulse(t, 9), 1e-9) << name;
    }
  }
  const std::string twice =
      config("SERVO_OUTPUT_RAW:servo", "[log.scale]\nm2 = {by = -1, about = 1500}\n");
  EXPECT_THROW(read("drive.tlog", twice), InputError);
  try {
    read("drive.tlog",
         "[log]\nrate = 10\nmirror_motors = true\ninputs = [\"m\"]\ntargets = [\"phi\"]\n"
         "[log.states]\nphi = \"ATTITUDE:roll\"\n[log.commands]\nm = "
         "\"SERVO_OUTPUT_RAW:servo8_raw\"\n");
    ADD_FAILURE() << "read without parameters";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("SERVO8_FUNCTION"), std::string::npos) << error.what();
  }
}

TEST(ArdusubParameters, DirectionsAreKnownOnceFunctionAndDirectionAre) {
  log::ParameterMap told;
  EXPECT_EQ(log::next_parameter(told, 3), "SERVO3_FUNCTION");
  EXPECT_EQ(log::pulse_factor(told, 3), std::nullopt);
  told["SERVO3_FUNCTION"] = 37;
  EXPECT_EQ(log::next_parameter(told, 3), "MOT_5_DIRECTION");
  EXPECT_EQ(log::pulse_factor(told, 3), std::nullopt);
  told["MOT_5_DIRECTION"] = -1;
  EXPECT_EQ(log::pulse_factor(told, 3), -1.0);
  told["SERVO4_FUNCTION"] = 181;
  EXPECT_EQ(log::pulse_factor(told, 4), 1.0);
  EXPECT_EQ(log::output_of("/mavlink/1/1/SERVO_OUTPUT_RAW:servo12_raw"), 12U);
  EXPECT_EQ(log::output_of("RCOU:C3"), 3U);
  EXPECT_EQ(log::output_of("RCIN:C3"), 0U);
  EXPECT_EQ(log::output_of("SERVO_OUTPUT_RAW"), 0U);
}

TEST_F(Ardusub, VoltageOfAGroundStationComesWithTheTimesOfReception) {
  std::string toml = read("drive.tlog").draft->toml();
  EXPECT_NE(toml.find("# voltage = \"SYS_STATUS:voltage_battery\""), std::string::npos) << toml;
  toml.replace(toml.find("clock = \"header\""), 16, "clock = \"receive\"");
  toml.replace(toml.find("# voltage"), 9, "voltage");
  toml.replace(toml.find("[log.scale]"), 11, "[log.scale]\nvoltage = 0.001");
  const log::Log log = read("drive.tlog", toml);
  EXPECT_NEAR(column(log, "voltage")[100], 16.0 - 0.01 * 30.0, 0.02);
}

TEST_F(Ardusub, ArmedOnlyWithoutArmedMessagesIsRefusedByName) {
  const testing::Tlog log = testing::small_tlog(100);
  testing::write_text(folder_ / "still.tlog", log.text());
  const std::string config =
      "[log]\nrate = 10\narmed_only = true\n[log.states]\nphi = \"ATTITUDE:roll\"\n"
      "[log.derived]\np = \"d(phi)\"\n";
  const std::string refusal = testing::message_of<InputError>([&] { read("still.tlog", config); });
  EXPECT_NE(refusal.find("while the autopilot says that its motors are armed; armed_only"),
            std::string::npos)
      << refusal;
}

TEST_F(Ardusub, ScalesAreCheckedByName) {
  const std::string head = "[log]\nrate = 10\n[log.states]\nphi = \"ATTITUDE:roll\"\n[log.scale]\n";
  for (const char* const line : {"phi = 0", "phi = inf", "phi = {about = 3}", "chi = 2",
                                 "phi = \"deg\"", "phi = {by = 1, abuot = 3}"}) {
    const std::string refusal =
        testing::message_of<InputError>([&] { read("drive.tlog", head + line + "\n"); });
    EXPECT_NE(refusal.find("c.toml:6"), std::string::npos) << line << ": " << refusal;
  }
}

}  // namespace
}  // namespace kelpie::ardusub_test
