// SPDX-License-Identifier: Apache-2.0
#include "log/read_log.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "bag/mats.hpp"
#include "bag/tlogs.hpp"
#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::read_log_test {
namespace {

using Names = std::vector<std::string>;

const std::string kBag = KELPIE_SOURCE_DIR "/tests/logs/bag/fixtures/zstd.mcap";

class ReadLog : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }

  log::Log read(const std::string& path, const std::string& config) {
    const log::LogConfig read = log::read_log_config(write("c.toml", config));
    return log::read_log({.path = path}, read, read.roles);
  }

  testing::TemporaryFolder folder_;
};

TEST_F(ReadLog, ATableWithoutDescriptionIsTakenAsItIs) {
  const std::string file = write("log.csv", "t,u,udot\n0,1,2\n1,3,1\n2,2,4\n");
  const log::Log log = log::read_log({.path = file}, {}, {});
  EXPECT_TRUE(log.sampling.sources.empty());
  const log::Dataset data = log.dataset();
  EXPECT_EQ(data.input_names, Names{"u"});
  EXPECT_EQ(data.targets, (std::vector<double>{2, 1, 4}));
}

TEST_F(ReadLog, TopicsOfABagBecomeSamples) {
  const log::Table table = read(kBag,
                                "[log]\nrate = 20\ndegree = 1\n"
                                "[log.states]\nx = \"/cmd:linear.x\"\n"
                                "[log.commands]\nspeed = \"/sample:speeds[0]\"\n"
                                "[log.derived]\nxdot = \"d(x)\"\n")
                               .table;
  EXPECT_EQ(table.names, (Names{"t", "x", "speed", "xdot"}));
  ASSERT_GT(table.rows(), 15U);
  // x = t is sent every 0.1 s; speed = 10 t + 0.2 comes 0.03 s after it.
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double t = table.columns[0][row];
    EXPECT_NEAR(table.columns[1][row], t, 1e-6);
    EXPECT_NEAR(table.columns[2][row], std::floor(10.0 * t - 0.3 + 1e-6) + 0.5, 1e-6) << t;
    if (t > 0.3 && t < 0.8) {
      EXPECT_NEAR(table.columns[3][row], 1.0, 1e-6);
    }
  }
}

TEST_F(ReadLog, ColumnsComeInTheOrderInWhichTheyAreListed) {
  const log::Log log =
      read(write("log.csv", "t,b,a,d\n0,1,2,3\n0.5,1,3,2\n1,2,3,4\n1.5,3,2,4\n"),
           "[log]\nrate = 2\ntime = 't'\ndegree = 1\nwindow = 2\n[log.states]\nv = 'b'\nu = 'a'\n"
           "[log.commands]\nn = 'd'\nm = 'd'\n[log.derived]\nvdot = 'd(v)'\n"
           "udot = 'd(u)'\n[log.units]\nu = 'm/s'\n");
  EXPECT_EQ(log.table.names, (Names{"t", "v", "u", "n", "m", "vdot", "udot"}));
  EXPECT_EQ(log.units, (std::map<std::string, std::string>{{"u", "m/s"}}));
}

TEST_F(ReadLog, TheTableTellsWhatIsKnownOfActuators) {
  const std::string csv = "t,u,n,udot\n0,1,1500,3\n0.5,2,1600,2\n1,1,1450,4\n";
  const auto config_of = [&](const std::string& actuators) {
    return log::read_log_config(write("c.toml", "[log]\n[log.actuators]\n" + actuators));
  };
  const log::LogConfig config = config_of("n = {neutral = 1500, dead_band = 25, astern = 0.8}\n");
  const log::KnownActuator known{.neutral = 1500.0, .dead_band = 25.0, .astern = 0.8};
  EXPECT_EQ(config.roles.actuators.at("n"), known);
  const log::Log log = log::read_log({.path = write("log.csv", csv)}, config, config.roles);
  EXPECT_EQ(log.dataset().actuators.at("n"), known);
  const auto said = [&](const std::string& actuators) {
    const std::string message = testing::message_of<InputError>([&] { config_of(actuators); });
    return message.substr(std::min(message.find("c.toml"), message.size()));
  };
  EXPECT_TRUE(said("n = {neutral = 'a'}\n").starts_with("c.toml:3: log.actuators.n.neutral: "))
      << said("n = {neutral = 'a'}\n");
  EXPECT_NE(said("n = {lag_s = 1}\n").find("lag_s"), std::string::npos);
  EXPECT_NE(said("n = {astern = 0}\n").find("c.toml:3: log.actuators.n.astern: has to be > 0"),
            std::string::npos)
      << said("n = {astern = 0}\n");
  EXPECT_NE(said("n = 1500\n").find("log.actuators.n"), std::string::npos);
}

TEST_F(ReadLog, MessagesTellTheUnitsOfTheirColumns) {
  const testing::Tlog tlog = testing::small_tlog(400);
  const std::string file = write("a.tlog", tlog.text());
  const Names columns{"ATTITUDE:roll", "ATTITUDE:rollspeed"};
  using Units = std::map<std::string, std::string>;
  EXPECT_EQ(log::read_columns({.path = file}, columns, bag::Clock::receive).units,
            (Units{{columns[0], "rad"}, {columns[1], "rad/s"}}));
  const log::Log log = read(file,
                            "[log]\nrate = 10\n[log.states]\np = 'ATTITUDE:rollspeed'\n"
                            "phi = 'ATTITUDE:roll'\n[log.derived]\npdot = 'd(p)'\n"
                            "[log.units]\nphi = 'deg'\n");
  EXPECT_EQ(log.units, (Units{{"p", "rad/s"}, {"pdot", "rad/s/s"}, {"phi", "rad"}}));
}

TEST_F(ReadLog, UnitsOfMotionAreConvertedInTablesAndInSamples) {
  const std::string csv = "t,u,n,udot\n0,100,1500,1\n500,200,1600,2\n1000,100,1450,1\n";
  const std::string file = write("log.csv", csv);
  log::Roles roles;
  roles.units = {{"t", "ms"}, {"u", "cm/s"}, {"udot", "g"}, {"n", "us"}};
  log::Dataset data = log::read_log({.path = file}, {}, roles).dataset();
  EXPECT_EQ(data.times_s, (std::vector<double>{0.0, 0.5, 1.0}));
  EXPECT_EQ(data.inputs, (std::vector<double>{1.0, 1500.0, 2.0, 1600.0, 1.0, 1450.0}));
  EXPECT_EQ(data.targets, (std::vector<double>{9.80665, 2.0 * 9.80665, 9.80665}));
  EXPECT_EQ(data.units.at("u").text(), "m s^-1");
  EXPECT_EQ(data.units.at("n").text(), "us") << "a neutral pulse is told in us";

  const log::Log sampled =
      read(write("slow.csv", "t,b,d\n0,100,2\n0.5,150,2\n1,200,3\n1.5,250,2\n"),
           "[log]\nrate = 2\ntime = 't'\ndegree = 1\nwindow = 2\n[log.states]\nu = 'b'\n"
           "[log.commands]\nn = 'd'\n[log.derived]\nudot = 'd(u)'\n"
           "[log.units]\nu = 'cm/s'\n");
  EXPECT_NEAR(sampled.table.columns[1][1], 1.5, 1e-9);
  EXPECT_NEAR(sampled.table.columns[3][1], 1.0, 1e-9) << "of the converted velocity";
  EXPECT_EQ(sampled.units.at("udot"), "m s^-1/s");
}

// 100 + 0.5 (v - 100) cm/s.
TEST_F(ReadLog, AUnitIsOfWhatTheScaleGives) {
  const std::string file = write("log.csv", "t,b,d\n0,100,2\n0.5,150,2\n1,200,3\n1.5,250,2\n");
  const auto config = [](const std::string& by, const std::string& unit) {
    return "[log]\nrate = 2\ntime = 't'\ndegree = 1\nwindow = 2\n[log.states]\nu = 'b'\n"
           "[log.commands]\nn = 'd'\n[log.derived]\nudot = 'd(u)'\n"
           "[log.units]\nu = '" +
           unit + "'\n[log.scale]\nu = {by = " + by + ", about = 100}\n";
  };
  for (const auto& [by, unit, expected] :
       {std::tuple("0.5", "cm/s", 1.25), std::tuple("1", "cm/s", 1.5),
        std::tuple("0.5", "m/s", 125.0)}) {
    EXPECT_NEAR(read(file, config(by, unit)).table.columns[1][1], expected, 1e-9) << by << unit;
  }
  EXPECT_NE(testing::message_of<InputError>([&] {
              read(file, config("100", "cm/s"));
            }).find("log.scale.u: and the unit together move values by a constant"),
            std::string::npos);
}

TEST_F(ReadLog, UnitsThatTheUserGivesAreKnownToTheDraft) {
  const auto text = [](const std::string& time) {
    std::string lines = time + ",u,n1\n";
    for (int k = 0; k < 400; ++k) {
      lines += std::to_string(40 * k) + "," + std::to_string(std::sin(0.01 * k)) + "," +
               std::to_string(std::cos(0.02 * k)) + "\n";
    }
    return lines;
  };
  for (const std::string time : {"t", "time_ms"}) {
    const std::string file = write("log.csv", text(time));
    if (time == "t") {
      const std::string said =
          testing::message_of<InputError>([&] { log::read_log({.path = file}, {}, {}); });
      EXPECT_NE(said.find("--units t=ms"), std::string::npos) << said;
      EXPECT_EQ(said.find("derivative of another"), std::string::npos) << said;
    } else {
      const log::Log log = log::read_log({.path = file}, {}, {});
      EXPECT_EQ(log.sampling.rate_hz, 25.0);
      EXPECT_NE(log.losses.find("time_ms: read in ms, as its name tells"), std::string::npos);
    }
    const log::Log log =
        log::read_log({.path = file}, {}, {.units = {{time, "ms"}, {"u", "knots"}}});
    EXPECT_EQ(log.sampling.rate_hz, 25.0);
    EXPECT_NEAR(log.table.columns[0].back(), 0.04 * 399, 0.05);
    const auto row = static_cast<std::size_t>(
        std::ranges::find_if(log.table.columns[0], [](double t) { return t > 7.99; }) -
        log.table.columns[0].begin());
    const std::vector<double>& u = log.table.columns[log.table.find("u")];
    EXPECT_NEAR(u[row], std::sin(2.0) * 1852.0 / 3600.0, 1e-4);
  }
  // Of a unit that the header has, too, there are not two conversions, nor in the second of two
  // logs.
  std::string both = text("t [ms]");
  both.replace(0, both.find('\n'), "t [ms],u [knots],n1");
  const std::string twice = write("log.csv", both);
  const log::Roles roles{.units = {{"t", "ms"}, {"u", "knots"}}};
  const log::Log first = log::read_log({.path = twice}, {}, roles);
  const log::Log second = log::read_log({.path = twice}, first.draft->config, roles);
  for (const log::Log* const log : {&first, &second}) {
    EXPECT_EQ(log->sampling.rate_hz, 25.0);
    const std::vector<double>& u = log->table.columns[log->table.find("u")];
    EXPECT_NEAR(std::ranges::max(u), 1852.0 / 3600.0, 1e-3);
  }
  EXPECT_NE(testing::message_of<InputError>([&] {
              log::read_log({.path = twice}, {}, {.units = {{"t", "m/s2"}}});
            }).find("is not a unit"),
            std::string::npos);
}

TEST_F(ReadLog, ATableWithRawColumnsIsServedAlike) {
  std::string text = "stamp,speed_x,rpm\n";
  for (int k = 0; k < 200; ++k) {
    // rpm is told every fourth row only.
    text += std::to_string(0.05 * k) + "," + std::to_string(0.1 * k * 0.05) + "," +
            (k % 4 == 0 ? std::to_string(k) : "") + "\n";
  }
  const log::Log log = read(write("log.csv", text),
                            "[log]\nrate = 10\ntime = \"stamp\"\n"
                            "[log.states]\nu = \"speed_x\"\n[log.commands]\nn = \"rpm\"\n"
                            "[log.derived]\nudot = \"d(u)\"\n");
  EXPECT_EQ(log.sampling.sources[1].faults.no_value, 150U);
  EXPECT_NEAR(log.table.columns[3][20], 0.1, 1e-4);
  EXPECT_EQ(log.table.columns[2][20], 40.0);
}

// A disarmed autopilot sends no pulses; an idling engine makes 800 to 2200 turns, or none.
TEST_F(ReadLog, APulseOfZeroIsRest) {
  const auto text = [](const std::string& header) {
    std::string lines = header + "\n";
    for (int k = 0; k < 400; ++k) {
      const bool is_armed = k >= 100;
      const double wave = std::sin(0.05 * k);
      lines += std::to_string(0.1 * k) + "," + std::to_string(wave) + "," +
               std::to_string(is_armed ? std::lround(1500.0 + 300.0 * wave) : 0) + "," +
               std::to_string(std::cos(0.05 * k)) + "\n";
    }
    return lines;
  };
  for (const std::string header : {"t,u,pwm1,udot", "t,u,motor1,x", "t,u,thruster_left [us],x"}) {
    const log::Log log = log::read_log({.path = write("log.csv", text(header))}, {}, {});
    EXPECT_NE(log.losses.find("0 is no pulse; it counts as rest, 1500 µs, in 100 rows"),
              std::string::npos)
        << log.losses;
    const log::Dataset data = log.dataset();
    ASSERT_EQ(data.input_names.size(), 2U);
    EXPECT_EQ(data.input(30)[1], 1500.0) << header;
    EXPECT_EQ(data.actuators.at(data.input_names[1]), (log::KnownActuator{.neutral = 1500.0}));
  }
  for (const std::string header : {"t,u,rpm1,udot", "t,u,motor_speed,udot", "t,u,n1 [rpm],udot"}) {
    const log::Log log = log::read_log({.path = write("log.csv", text(header))}, {}, {});
    EXPECT_EQ(log.losses, "") << header;
    EXPECT_EQ(log.dataset().input(30)[1], 0.0) << header;
  }
}

TEST_F(ReadLog, ColumnsOfABagAreTakenAsRecorded) {
  const log::Log log =
      log::read_columns({.path = kBag}, Names{"/cmd:linear.x"}, bag::Clock::receive);
  EXPECT_EQ(log.table.names, (Names{"t", "/cmd:linear.x"}));
  EXPECT_NEAR(log.table.columns[1][3] - log.table.columns[1][0], 0.3, 1e-6);
}

TEST_F(ReadLog, WhatADamagedBagLostIsTold) {
  std::ifstream whole(kBag, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(whole), {}};
  const std::string file = write("cut.mcap", bytes.substr(0, bytes.size() - 100));
  const Names columns{"/cmd:linear.x"};
  EXPECT_THROW(log::read_columns({.path = file}, columns, bag::Clock::receive), InputError);
  const log::Log log = log::read_columns({.path = file, .mode = bag::ReadMode::recover}, columns,
                                         bag::Clock::receive);
  EXPECT_TRUE(log.losses.starts_with("lost: ")) << log.losses;
}

TEST_F(ReadLog, ALiveStreamIsDescribedByTheSameTable) {
  const auto plan_of = [&](const std::string& more) {
    const log::LogConfig config =
        log::read_log_config(write("c.toml", "[log]\nrate = 20\n" + more +
                                                 "[log.states]\nx = \"/cmd:linear.x\"\n"
                                                 "[log.commands]\nspeed = \"/sample:speeds[0]\"\n"
                                                 "[log.derived]\nxdot = \"d(x)\"\n"));
    return log::stream_plan(config, config.roles);
  };
  const StreamPlan plan = plan_of("gap = 0.5\nfilter = \"causal\"\nlag = 0.1\n");
  EXPECT_EQ(plan.inputs, (Names{"x", "speed"}));
  EXPECT_EQ(plan.targets, Names{"xdot"});
  EXPECT_EQ(plan.rate_hz, 20.0);
  EXPECT_EQ(plan.sources[1].lag_s, 0.1);
  EXPECT_EQ(plan_of("inputs = [\"x\"]\n").inputs, Names{"x"});
  const std::string said = testing::message_of<InputError>([&] { plan_of("lag = \"auto\"\n"); });
  EXPECT_NE(said.find("c.toml: log.lag.speed: \"auto\" takes a whole log"), std::string::npos);
}

// What a replay has to know beforehand to end with the rows of a log.
TEST_F(ReadLog, TheReachOfABagIsThatOfItsRows) {
  const std::string table =
      "[log]\nrate = 20\nlag = 0.1\n"
      "[log.states]\nx = \"/cmd:linear.x\"\n"
      "[log.commands]\nspeed = \"/sample:speeds[0]\"\n";
  const log::Log log = read(kBag, table);
  const log::LogConfig config = log::read_log_config(folder_ / "c.toml");
  const log::Reach reach = log::read_reach({.path = kBag}, config);
  EXPECT_GE(reach.end_s, log.table.columns[0].back());
  EXPECT_LT(reach.end_s, log.table.columns[0].back() + 0.05);
  EXPECT_GT(reach.origin_ns, 0);
  EXPECT_EQ(log.sampling.rate_hz, 20.0);
}

TEST_F(ReadLog, WhatIsWrongIsNamedWithItsPlace) {
  const std::string states = "[log.states]\nx = \"/cmd:linear.x\"\n";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"[log]\nrate = 10\n", "zstd.mcap: the signals to use are unclear:\n  - no velocities"},
      {states, "c.toml: log.rate: is missing"},
      {"[log]\nrat = 10\n" + states, "c.toml:2: log.rat: unknown key (did you mean 'rate'?)"},
      {"[logs]\nrate = 10\n", "c.toml:1: logs: unknown table (did you mean 'log'?)"},
      {"[log]\ninputs = \"u\"\n", "c.toml:2: log.inputs: has to be a list of column names"},
      {"[log]\nunits = \"m/s\"\n", "c.toml:2: log.units: has to be a table of units"},
      {"[log]\nrate = 10\ntime = \"t\"\n" + states, "log.time: belongs to CSV files"},
      {"[log]\nrate = 10\nclock = \"haeder\"\n" + states, "did you mean 'header'?"},
      {"[log]\nrate = 10\n[log.states]\nx = \"/cmds:linear.x\"\n",
       "zstd.mcap: /cmds: there is no such topic (did you mean '/cmd'?)"},
      {"[log]\nrate = 10\n" + states + "[log.derived]\nxdot = \"x'\"\n",
       "c.toml:6: log.derived.xdot: 'x'' has to be the derivative of a column, as in \"d(u)\""},
      {"[log]\nrate = 10\n" + states + "[log.lag]\ny = 0.1\n", "log.lag.y: 'y' is no state"},
      {"[log]\nrate = 10\nlag = \"atuo\"\n[log.commands]\nx = \"/cmd:linear.x\"\n",
       "log.lag: has to be \"auto\" or a number of s"},
      {"[log]\nrate = 10\nclock = \"header\"\n" + states, "/cmd: geometry_msgs/msg/Twist has no "},
      {"[log]\nrate = 10\nvectors = [{columns = [\"x\"], from = \"FLU\", to = \"FRD\"}]\n" + states,
       "log.vectors[0].columns: has to be a list of three columns"},
      {"[log]\nvectors = [{columns = [\"x\", \"y\", \"z\"], from = \"FLU\"}]\n",
       "c.toml:2: log.vectors[0].to: is missing"},
      {"[log]\nvectors = [{columns = [\"x\", \"y\", \"z\"], from = \"FUL\", to = \"FRD\"}]\n",
       "c.toml:2: log.vectors[0].from: "},
      {"[log]\nvectors = [{columns = [\"x\", \"y\", \"z\"], from = \"NED\", to = \"FRD\", "
       "attitude = \"phi\"}]\n",
       "c.toml:2: log.vectors[0].attitude: has to be a list of roll, pitch and yaw"},
      {"[log]\nvectors = [{columns = [\"x\", \"y\", \"z\"], from = \"NED\", to = \"FRD\", "
       "attitude = [\"p\", \"t\", \"s\"], angles = \"grad\"}]\n",
       "log.vectors[0].angles: 'grad' is no choice (did you mean 'rad'?); there are rad, deg"},
  };
  for (const auto& [config, message] : cases) {
    const std::string said =
        testing::message_of<InputError>([&, &text = config] { read(kBag, text); });
    EXPECT_NE(said.find(message), std::string::npos) << config << said;
  }
}

#ifdef KELPIE_WITH_MATIO
TEST_F(ReadLog, ATimeThatMatlabsFileHasByAnotherNameOrNotAtAllIsTold) {
  const std::vector<double> x{0.0, 1.0, 2.0, 3.0, 4.0};
  const std::string states = "[log.states]\nx = \"workspace:x\"\n";
  const std::string other =
      write("a.mat", testing::mat_file({{"x", x}, {"clock", {0.0, 0.25, 0.5, 0.75, 1.0}}}));
  const std::string none = write("b.mat", testing::mat_file({{"x", x}}));
  const log::Table named = read(other, "[log]\nrate = 4\ntime = \"clock\"\n" + states).table;
  EXPECT_EQ(named.columns, (std::vector<std::vector<double>>{{0.0, 0.25, 0.5, 0.75, 1.0}, x}));
  const log::Table counted = read(none, "[log]\nrate = 2\n" + states).table;
  EXPECT_EQ(counted.columns, (std::vector<std::vector<double>>{{0.0, 0.5, 1.0, 1.5, 2.0}, x}));
  const std::string said = testing::message_of<InputError>(
      [&] { read(none, "[log]\nrate = 2\ntime = \"clock\"\n" + states); });
  EXPECT_NE(said.find("b.mat: clock: there is no vector"), std::string::npos) << said;
}
#endif

TEST_F(ReadLog, TheExampleMakesSamplesOfARealBag) {
  const auto bag = testing::data_file("flatfish_bag");
  if (bag.empty()) {
    GTEST_SKIP() << "flatfish_bag is in neither $KELPIE_DATA_DIR nor ../shared/data";
  }
  const log::LogConfig config = log::read_log_config(KELPIE_SOURCE_DIR "/examples/flatfish.toml");
  const log::Log log = log::read_log({.path = bag.string()}, config, config.roles);
  EXPECT_TRUE(std::ranges::any_of(log.sampling.sources,
                                  [](const auto& source) { return source.faults.gaps > 0; }));
  std::size_t whole = 0;
  for (std::size_t row = 0; row < log.table.rows(); ++row) {
    whole +=
        std::ranges::all_of(log.table.columns, [&](const auto& c) { return std::isfinite(c[row]); })
            ? 1
            : 0;
  }
  EXPECT_GT(whole, 800U);
  EXPECT_LT(whole, log.table.rows());
}

}  // namespace
}  // namespace kelpie::read_log_test
