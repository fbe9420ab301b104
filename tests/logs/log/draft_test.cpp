// SPDX-License-Identifier: Apache-2.0
#include "log/draft.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "log/candidates.hpp"
#include "support.hpp"

namespace kelpie::draft_test {
namespace {

using Names = std::vector<std::string>;

// 400 rows at 20 Hz of columns that all move, but those that begin with "still".
log::Table table_of(const std::string& names) {
  log::Table table;
  table.source = "log.csv";
  table.names = split_text(names, ',');
  for (std::size_t row = 0; row < 400; ++row) {
    table.lines.push_back(row + 2);
  }
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    std::vector<double>& values = table.columns.emplace_back();
    for (std::size_t row = 0; row < 400; ++row) {
      const double t = 0.05 * static_cast<double>(row);
      const bool is_still = table.names[column].starts_with("still");
      values.push_back(column == 0 ? t
                       : is_still  ? 3.0
                                   : std::sin(t * (1.0 + 0.3 * double(column))));
    }
  }
  return table;
}

// A topic whose fields all range from -1 to 1.
bag::TopicReport topic(const std::string& name, const std::string& type, const Names& fields,
                       double rate_hz = 20.0) {
  bag::TopicReport report{.name = name, .type = type, .messages = 1000, .rate_hz = rate_hz};
  for (const std::string& field : fields) {
    bag::FieldRange& range = report.fields.emplace_back(
        bag::FieldRange{.path = field, .low = -1.0, .high = 1.0, .finite = 1000});
    if (field.ends_with("[]")) {
      range.elements.assign(4, {.low = -1.0, .high = 1.0, .finite = 1000});
    }
  }
  return report;
}

const Names kTwist{"twist.twist.linear.x",  "twist.twist.linear.y",  "twist.twist.linear.z",
                   "twist.twist.angular.x", "twist.twist.angular.y", "twist.twist.angular.z"};

bag::TopicReport odometry(const std::string& name) {
  return topic(name, "nav_msgs/msg/Odometry", kTwist);
}

log::Draft draft(const std::vector<bag::TopicReport>& topics) {
  bag::BagReport report;
  report.duration_s = 1000.0 / 20.0;
  report.topics = topics;
  return log::draft_of(report, {.path = "mission"});
}

std::string inputs_of(const log::Draft& draft) {
  return join_text(draft.config.roles.inputs, ",");
}

bool is_open_about(const log::Draft& draft, const std::string& words) {
  return join_text(draft.open, "\n").find(words) != std::string::npos;
}

TEST(Draft, KnowsTheHabitsOfCsvFiles) {
  struct Habit {
    std::string columns;
    std::string inputs;
    std::string targets;
  };
  const std::vector<Habit> habits{
      {"t,u,v,r,n1,n2", "u,v,r,n1,n2", "udot,vdot,rdot"},
      {"time,surge,sway,yaw_rate,pwm1,pwm2", "u,v,r,pwm1,pwm2", "udot,vdot,rdot"},
      {"Time,vx,vy,wz,thruster_left,thruster_right", "u,v,r,thruster_left,thruster_right",
       "udot,vdot,rdot"},
      {"timestamp,vel_x,vel_y,yawspeed,cmd_port,cmd_starboard,battery_voltage",
       "u,v,r,cmd_port,cmd_starboard", "udot,vdot,rdot"},
      {"stamp,u,v,r,rudder,rps", "u,v,r,rps,rudder", "udot,vdot,rdot"},
      {"seconds,linear_x,angular_z,motorLeft,motorRight", "u,r,motorLeft,motorRight", "udot,rdot"},
      {"t,u,r,delta,rpm,rpm_limit,temperature_motor", "u,r,rpm,delta", "udot,rdot"},
      {"t,u,v,w,p,q,r,tau_x,tau_y,tau_n", "u,v,w,r,tau_x,tau_y,tau_n", "udot,vdot,wdot,rdot"},
      {"elapsed_s,surge_velocity,heading_rate,servo1,servo2,still_servo3", "u,r,servo1,servo2",
       "udot,rdot"},
  };
  for (const Habit& habit : habits) {
    const log::Draft found = log::draft_of(table_of(habit.columns));
    ASSERT_TRUE(found.is_complete()) << habit.columns << "\n" << join_text(found.open, "\n");
    const log::LogConfig config = found.config;
    EXPECT_EQ(join_text(config.roles.inputs, ","), habit.inputs) << habit.columns;
    EXPECT_EQ(join_text(config.roles.targets, ","), habit.targets) << habit.columns;
    EXPECT_EQ(config.roles.time, split_text(habit.columns, ',').front());
    EXPECT_EQ(config.roles.rate_hz, 20.0) << "of 20 s: all rows there are";
  }
}

TEST(Draft, TellsWhichColumnsOfATableAreNotUsed) {
  const log::Draft found =
      log::draft_of(table_of("t,u,v,r,motor,steering,az,n_sats,imu_az,still_rpm,mode_3"));
  ASSERT_TRUE(found.is_complete()) << join_text(found.open, "\n");
  EXPECT_EQ(inputs_of(found), "u,v,r,motor,steering");
  EXPECT_EQ(found.taken.back(), "not used: az, n_sats, imu_az, mode_3");
  EXPECT_EQ(inputs_of(log::draft_of(table_of("t,u,r,n_port,az_port,helm"))),
            "u,r,n_port,az_port,helm");
}

TEST(Draft, TakesTheHeadingOfATableForTheCurrentAndNotAsAnInput) {
  log::Table table = table_of("t,u,v,r,n1,heading_deg");
  const log::LogConfig config = log::draft_of(table).config;
  EXPECT_EQ(config.plan.sources[config.plan.source("psi")].from, "heading_deg");
  EXPECT_EQ(join_text(config.roles.inputs, ","), "u,v,r,n1");
  table.columns[5].back() = std::nan("");  // rows end with the first signal to end
  const log::Draft without = log::draft_of(table);
  EXPECT_EQ(without.toml().find("psi"), std::string::npos) << without.toml();
  EXPECT_EQ(without.taken.back(), "not used: heading_deg");
}

TEST(Draft, EveryUnitOfMotionBecomesOneOfTheSi) {
  log::Table table = table_of("t,u,v,r,n1,rudder");
  table.units = {"s", "kts", "m/sec", "deg/sec", "RPM", "degrees"};
  const log::Draft found = log::draft_of(table);
  ASSERT_TRUE(found.is_complete()) << join_text(found.open, "\n");
  const log::LogConfig config = found.config;
  const auto scale = [&](const std::string& name) {
    return config.plan.sources[config.plan.source(name)].scale;
  };
  EXPECT_NEAR(scale("u"), 1852.0 / 3600.0, 1e-12);
  EXPECT_EQ(scale("v"), 1.0);
  EXPECT_NEAR(scale("r"), std::acos(-1.0) / 180.0, 1e-12);
  EXPECT_EQ(scale("n1"), 1.0);
  EXPECT_NEAR(scale("rudder"), std::acos(-1.0) / 180.0, 1e-12);
  for (const auto& [name, unit] :
       {std::pair("u", "m/s"), std::pair("v", "m/s"), std::pair("r", "rad/s"),
        std::pair("rdot", "rad/s^2"), std::pair("rudder", "rad")}) {
    EXPECT_EQ(config.roles.units.at(name), unit) << name;
  }
}

TEST(Draft, KnowsWherePulsesOfServosRest) {
  log::Table table = table_of("t,u,v,r,pwm1,pwm2,rpm");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    table.columns[4][row] = 1500.0 + std::round(400.0 * table.columns[4][row]);
    table.columns[5][row] = 1500.0 + std::round(100.0 * table.columns[5][row]);
  }
  const log::Draft found = log::draft_of(table);
  ASSERT_TRUE(found.is_complete()) << found.toml();
  const auto actuators = found.config.roles.actuators;
  ASSERT_EQ(actuators.size(), 2U) << found.toml();
  EXPECT_EQ(actuators.at("pwm1"), (log::KnownActuator{.neutral = 1500.0}));
  EXPECT_EQ(actuators.at("pwm2"), (log::KnownActuator{.neutral = 1500.0}));
  EXPECT_NE(join_text(found.taken, "\n").find("pulses that rest at 1500 µs"), std::string::npos);
  std::vector<double>& pulses = table.columns[4];
  const std::vector<double> good = pulses;
  const auto is_pulse = [&] {
    return log::draft_of(table).config.roles.actuators.contains("pwm1");
  };
  for (const double extreme : {799.0, 2201.0, 1050.5}) {
    pulses = good;
    pulses[0] = extreme;
    EXPECT_FALSE(is_pulse()) << extreme;
  }
  pulses = good;
  std::ranges::for_each(pulses, [](double& value) { value = std::max(value, 1500.0); });
  EXPECT_FALSE(is_pulse());  // to one side: a servo's end may be its rest
}

TEST(Draft, PulsesThatNeverLeaveTheDeadBandAreTold) {
  const auto remarks = [](double reach_us) {
    log::Table table = table_of("t,u,v,r,pwm1,pwm2");
    for (std::size_t row = 0; row < table.rows(); ++row) {
      for (const std::size_t pwm : {4U, 5U}) {
        table.columns[pwm][row] =
            1500.0 + std::round(reach_us * std::tanh(table.columns[pwm][row]));
      }
    }
    return join_text(log::draft_of(table).remarks, "\n");
  };
  const std::string told = "usual motor controllers stand still (1475 to 1525 µs)";
  EXPECT_NE(remarks(20.0).find(told), std::string::npos) << remarks(20.0);
  EXPECT_EQ(remarks(200.0).find(told), std::string::npos) << remarks(200.0);
}

TEST(Draft, WhereNothingIsKnownItListsTheFieldsThatChange) {
  const log::Draft found = draft({topic("/state", "pkg/msg/State", {"forward", "push"})});
  EXPECT_NE(found.unclear().find("\n  - the fields that change are /state:forward, /state:push\n"),
            std::string::npos)
      << found.unclear();
  EXPECT_NE(found.toml().find("#   NAME = \"/state:push\""), std::string::npos) << found.toml();
}

TEST(Draft, TheColumnOfTheTimeMayBeNamed) {
  const log::Table table = table_of("t_bag,u,v,r,n1,n2");
  EXPECT_TRUE(is_open_about(log::draft_of(table), "--time names the column"));
  EXPECT_EQ(log::draft_of(table, {.time = "t_bag"}).config.roles.time, "t_bag");
}

TEST(Draft, WhereTwoReadingsAreLikelyItAsks) {
  EXPECT_TRUE(is_open_about(log::draft_of(table_of("t,u,r,pwm1,pwm2,rpm1,rpm2")),
                            "commands: pwm1, pwm2, or rpm1, rpm2: which of them?"));
  EXPECT_TRUE(is_open_about(log::draft_of(table_of("t,u,surge,r,n1")), "velocities: u, or surge"));
  EXPECT_TRUE(is_open_about(log::draft_of(table_of("n,u,r,thruster1")), "time: no column"));
  EXPECT_TRUE(is_open_about(log::draft_of(table_of("t,a,b,n1")), "no velocities are known"));
  EXPECT_TRUE(is_open_about(log::draft_of(table_of("t,u,r,depth")), "no commands are known"));
  const bag::TopicReport thrust = topic("/thrusters", "std_msgs/msg/Float64MultiArray", {"data[]"});
  const log::Draft two = draft({odometry("/ekf/odom"), odometry("/slam/odom"), thrust});
  EXPECT_TRUE(is_open_about(two, "/ekf/odom (nav_msgs/msg/Odometry), or /slam/odom"));
  EXPECT_NE(two.toml().find("# u = \"/slam/odom:twist.twist.linear.x\""), std::string::npos)
      << two.toml();
  EXPECT_TRUE(is_open_about(
      draft({odometry("/odom"), thrust, topic("/rc/out", "mavros_msgs/msg/RCOut", {"channels[]"})}),
      "commands: "));
}

TEST(Draft, KnowsMessagesAndWhatIsAVehiclesOwn) {
  const Names locals{"vx", "vy", "vz"};
  const Names attitudes{"roll", "pitch", "yaw", "rollspeed", "pitchspeed", "yawspeed"};
  const Names servos{"servo1_raw", "servo2_raw", "servo12_raw"};
  const std::vector<bag::TopicReport> dive{
      topic("LOCAL_POSITION_NED", "LOCAL_POSITION_NED", locals, 3.0),
      topic("ATTITUDE", "ATTITUDE", attitudes),
      topic("/mavlink/1/100/ATTITUDE", "ATTITUDE", attitudes),
      topic("SERVO_OUTPUT_RAW", "SERVO_OUTPUT_RAW", servos, 2.0),
      topic("VFR_HUD", "VFR_HUD", {"throttle"}),
      topic("/mavlink/255/190/MANUAL_CONTROL", "MANUAL_CONTROL", {"x", "y", "z", "r"})};
  const log::Draft found = draft(dive);
  ASSERT_TRUE(found.is_complete()) << join_text(found.open, "\n");
  EXPECT_EQ(inputs_of(found), "u,v,w,r,servo1_raw,servo2_raw");
  const log::LogConfig config = found.config;
  ASSERT_EQ(config.plan.vectors.size(), 1U);
  EXPECT_EQ(config.plan.vectors[0].attitude, (Names{"phi", "theta", "psi"}));
  EXPECT_EQ(config.plan.vectors[0].from, Frame::ned);
  EXPECT_GE(config.plan.gap_s, 1.5);
  EXPECT_NE(join_text(found.remarks, "\n").find("commands come at 2 Hz"), std::string::npos);
  EXPECT_NE(found.toml().find("# x = \"/mavlink/255/190/MANUAL_CONTROL:x\""), std::string::npos)
      << found.toml();
  EXPECT_TRUE(is_open_about(draft({dive[0], dive[3]}), "there is no attitude to turn it by"));
}

TEST(Draft, TakesTheFirstOfSeveralInstancesAndTellsDegrees) {
  const Names fields{"VN", "VE", "VD", "Roll", "Pitch", "Yaw"};
  bag::TopicReport first = topic("XKF1[0]", "XKF1", fields);
  first.fields[5].high = 359.0;
  const log::Draft found =
      draft({first, topic("XKF1[1]", "XKF1", fields), topic("RATE", "RATE", {"R", "P", "Y"}),
             topic("RCOU", "RCOU", {"C1", "C2"})});
  ASSERT_TRUE(found.is_complete()) << join_text(found.open, "\n");
  const log::LogConfig config = found.config;
  EXPECT_EQ(config.plan.sources[config.plan.source("u")].from, "XKF1[0]:VN");
  EXPECT_TRUE(config.plan.vectors.at(0).is_in_degrees);
  for (bag::FieldRange& field : first.fields) {
    field.unit = field.path.starts_with("V") ? "m/s" : "deg";
  }
  const log::LogConfig turned = draft({first, topic("RCOU", "RCOU", {"C1", "C2"})}).config;
  EXPECT_FALSE(turned.plan.vectors.at(0).is_in_degrees);
  EXPECT_NEAR(turned.plan.sources[turned.plan.source("psi")].scale, std::acos(-1.0) / 180.0, 1e-12);
  EXPECT_EQ(turned.roles.units.at("psi"), "rad");
}

TEST(Draft, TakesTopicsOfOneNumberByTheirNames) {
  const log::Draft found = draft({topic("/boat/surge_speed", "std_msgs/Float64", {"data"}),
                                  topic("/boat/yaw_rate", "std_msgs/Float64", {"data"}),
                                  topic("/boat/thruster_left/cmd", "std_msgs/Float64", {"data"}),
                                  topic("/boat/thruster_right/cmd", "std_msgs/Float64", {"data"}),
                                  topic("/camera/colour", "x_msgs/Colour", {"r", "g", "b"})});
  ASSERT_TRUE(found.is_complete()) << join_text(found.open, "\n");
  EXPECT_EQ(inputs_of(found), "u,r,thruster_left,thruster_right");
}

TEST(Draft, TakesFieldsOfUnknownTypesByTheirNames) {
  const log::Draft found =
      draft({odometry("/odom"), topic("/drive", "x_msgs/Drive",
                                      {"header.stamp.sec", "left_thruster", "right_thruster"})});
  ASSERT_TRUE(found.is_complete()) << join_text(found.open, "\n");
  EXPECT_EQ(inputs_of(found), "u,v,w,r,left_thruster,right_thruster");
}

TEST(Draft, AsksForTheTimesOfRowsThatHaveNone) {
  const Names fields{"u", "r", "thruster"};
  EXPECT_TRUE(draft({topic("run", "matlab/Rows", fields)}).is_complete());
  EXPECT_TRUE(is_open_about(draft({topic("run", "matlab/RowsWithoutTime", fields)}),
                            "time: the rows of run have none"));
}

TEST(Draft, MoreCommandsThanAModelTakesAreAskedForInFewWords) {
  std::string names = "t,u,r";
  for (int k = 0; k < 3000; ++k) {
    names += ",n" + std::to_string(k);
  }
  const log::Draft found = log::draft_of(table_of(names));
  EXPECT_TRUE(is_open_about(found, "3000 are more than a model takes"));
  EXPECT_LT(found.toml().size(), 3000U);
}

TEST(Draft, NamesThatCannotBeWrittenArePassedOver) {
  const std::string evil = "/odom\"\nrate = 1\n";
  for (const std::string& name : {evil, std::string("/\xff\xfe"), std::string("/a\x1b[31m")}) {
    const log::Draft found = draft({odometry(name)});
    EXPECT_FALSE(found.is_complete());
    EXPECT_EQ(found.toml().find(name), std::string::npos);
  }
  const log::Draft quoted = draft(
      {odometry("/o\"d\\om"), topic("/thrust\"ers", "std_msgs/msg/Float64MultiArray", {"data[]"})});
  ASSERT_TRUE(quoted.is_complete());
  EXPECT_EQ(quoted.config.plan.sources[0].from.substr(0, 4), "/o\"d");
}

TEST(Draft, ATableOfSamplesIsTakenAsItIs) {
  const log::Draft found = log::draft_of(table_of("t,u,n1,udot"));
  ASSERT_TRUE(found.is_complete());
  EXPECT_FALSE(found.config.makes_samples());
  EXPECT_EQ(inputs_of(found), "u,n1");
  EXPECT_TRUE(is_open_about(log::draft_of(table_of("k,u,n1,udot")), "rate: "));
}

TEST(Draft, ExpandsFieldsAndTakesNamesApart) {
  EXPECT_EQ(log::expanded("a.{x,y}.b[0..1]"),
            (Names{"a.x.b[0]", "a.x.b[1]", "a.y.b[0]", "a.y.b[1]"}));
  EXPECT_EQ(log::words_of("ThrusterLeft/Cmd [V]"), (Names{"thruster", "left", "cmd"}));
  EXPECT_EQ(log::words_of("a[12]"), (Names{"a", "12"}));
}

}  // namespace
}  // namespace kelpie::draft_test
