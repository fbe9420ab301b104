// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/core/error.hpp"
#include "log/pose_log.hpp"
#include "log/read_log.hpp"
#include "support.hpp"

namespace kelpie::draft_pose_test {
namespace {

using Names = std::vector<std::string>;
using testing::PoseLog;

class PoseConfig : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }

  log::Log read(const std::string& csv, const std::string& config) {
    const log::LogConfig read = log::read_log_config(write("c.toml", config));
    return log::read_log({.path = write("log.csv", csv)}, read, read.roles);
  }

  std::string refusal(const std::string& csv, const std::string& config) {
    return testing::message_of<InputError>([&] { read(csv, config); });
  }

  static const std::vector<double>& column(const log::Log& log, const std::string& name) {
    return log.table.columns[log.table.find(name)];
  }

  testing::TemporaryFolder folder_;
};

const std::string kCommands = "[log.commands]\nn = \"n\"\nm = \"m\"\n";
const std::string kPlane = "[log]\ntime = \"t\"\nrate = 5\npose = [\"x\", \"y\", \"psi\"]\n";

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), sizeof(double) * a.size()) == 0;
}

double deviation(const log::Log& log, const std::string& name, const PoseLog& truth,
                 double PoseLog::Sample::*member) {
  double sum = 0.0;
  double count = 0.0;
  const std::vector<double>& t = log.table.columns[log.table.find("t")];
  for (std::size_t row = 0; row < t.size(); ++row) {
    const double value = log.table.columns[log.table.find(name)][row];
    if (std::isfinite(value)) {
      const auto at = static_cast<std::size_t>(std::lround(t[row] * 10.0));
      sum += std::pow(value - truth.samples.at(at).*member, 2.0);
      count += 1.0;
    }
  }
  return std::sqrt(sum / count);
}

TEST_F(PoseConfig, PosesBecomeRowsOfVelocitiesCommandsAndAccelerations) {
  const PoseLog truth(300.0);
  const log::Log log = read(truth.csv(0.001), kPlane + "window = 1.2\n" + kCommands);
  const log::Dataset data = log.dataset();
  EXPECT_EQ(data.target_names, (Names{"udot", "vdot", "rdot"}));
  EXPECT_EQ(data.input_names, (Names{"u", "v", "r", "n", "m"}));
  EXPECT_LT(deviation(log, "u", truth, &PoseLog::Sample::u), 0.01);
  EXPECT_LT(deviation(log, "v", truth, &PoseLog::Sample::v), 0.01);
  EXPECT_LT(deviation(log, "vdot", truth, &PoseLog::Sample::vdot), 0.03);
  EXPECT_EQ(log.sampling.pose_half_s, 0.6);
  EXPECT_FALSE(log.sampling.window.has_value());
}

TEST_F(PoseConfig, TheWindowGrowsWithTheNoiseAndStaysNearTheBest) {
  const PoseLog truth(600.0);
  double before = 0.0;
  for (const double noise : {0.002, 0.02, 0.1}) {
    const std::string csv = truth.csv(noise);
    const log::Log found = read(csv, kPlane + kCommands);
    ASSERT_TRUE(found.sampling.window.has_value());
    EXPECT_GT(found.sampling.pose_half_s, before) << noise;
    before = found.sampling.pose_half_s;
    double best = 1e9;
    for (const auto& tried : found.sampling.window->tried) {
      const log::Log other =
          read(csv, kPlane + "window = " + std::to_string(2.0 * tried.half_s) + "\n" + kCommands);
      best = std::min(best, deviation(other, "udot", truth, &PoseLog::Sample::udot));
    }
    EXPECT_LT(deviation(found, "udot", truth, &PoseLog::Sample::udot), 1.5 * best) << noise;
  }
}

TEST_F(PoseConfig, TheWindowIsTheSameBeforeTimeZero) {
  PoseLog truth(300.0);
  const double found = read(truth.csv(0.02), kPlane + kCommands).sampling.pose_half_s;
  for (PoseLog::Sample& sample : truth.samples) {
    sample.t -= 400.0;
  }
  EXPECT_NEAR(read(truth.csv(0.02), kPlane + kCommands).sampling.pose_half_s, found, 1e-6);
}

TEST_F(PoseConfig, TablesListsAndOptionsMeanTheSame) {
  const PoseLog truth(200.0);
  const std::string csv = truth.csv(0.01);
  const log::Log list = read(csv, kPlane + kCommands);
  const log::Log table =
      read(csv, "[log]\ntime = \"t\"\nrate = 5\npose = {x = \"x\", y = \"y\", yaw = \"psi\"}\n" +
                    kCommands);
  const log::Log states =
      read(csv,
           "[log]\ntime = \"t\"\nrate = 5\npose = {x = \"east\", y = \"north\", "
           "yaw = \"angle\"}\n[log.states]\neast = \"x\"\nnorth = \"y\"\n"
           "angle = \"psi\"\n" +
               kCommands);
  const log::Log option = log::read_log(
      {.path = write("log.csv", csv)}, {},
      {.inputs = {"u", "v", "r", "n", "m"}, .rate_hz = 5.0, .pose = {"x", "y", "yaw=psi"}});
  for (const char* const name : {"u", "v", "r", "udot", "vdot", "rdot", "n"}) {
    EXPECT_TRUE(same_bits(column(list, name), column(table, name))) << name;
    EXPECT_TRUE(same_bits(column(list, name), column(states, name))) << name;
    EXPECT_TRUE(same_bits(column(list, name), column(option, name))) << name;
  }
}

TEST_F(PoseConfig, AnglesInDegreesAreConvertedOnceWhateverElseIsSaidOfThem) {
  const PoseLog truth(60.0);
  std::string csv = "t,x,y,psi,n,m\n";
  std::string in_degrees = csv;
  for (const PoseLog::Sample& one : truth.samples) {
    const auto row = [&](double psi) {
      return fmt::format("{:.9g},{:.9g},{:.9g},{:.12g},{:.9g},{:.9g}\n", one.t, one.x, one.y, psi,
                         one.n, one.m);
    };
    csv += row(one.psi);
    in_degrees += row(one.psi * 180.0 / 3.14159265358979323846);
  }
  const std::string head = "[log]\ntime = \"t\"\nrate = 5\nwindow = 1.5\n";
  const std::string pose = "pose = {x = \"x\", y = \"y\", yaw = \"psi\"";
  const log::Log plain = read(csv, head + pose + "}\n" + kCommands);
  for (const char* const more : {"", "units = {yaw = \"deg\"}\n", "scale = {yaw = 1}\n"}) {
    const log::Log log = read(in_degrees, head + more + pose + ", angles = \"deg\"}\n" + kCommands);
    std::size_t known = 0;
    for (const char* const name : {"u", "r"}) {
      for (std::size_t row = 0; row < log.table.rows(); ++row) {
        const double expected = column(plain, name)[row];
        const double found = column(log, name)[row];
        known += std::isfinite(found) ? 1 : 0;
        EXPECT_TRUE(std::isnan(expected) ? std::isnan(found) : std::abs(found - expected) < 1e-6)
            << more << name << row;
      }
    }
    EXPECT_GT(known, 400U);
  }
  EXPECT_NE(
      refusal(csv, head + "units = {yaw = \"rad\"}\n" + pose + ", angles = \"deg\"}\n" + kCommands)
          .find("but 'units' says yaw = \"rad\""),
      std::string::npos);
}

TEST_F(PoseConfig, DegreesTurnsAndMissingCellsAreNoMatter) {
  const PoseLog truth(200.0);
  const std::string config = kPlane + "window = 1.5\n" + kCommands;
  const log::Log plain = read(truth.csv(0.0), config);
  const log::Log turned = read(truth.csv(0.0, 2.5), config);
  const std::string holes = truth.csv(0.0);  // every seventh x is missing, one line stands twice
  std::size_t line = 0;
  std::string with_holes;
  for (std::size_t begin = 0; begin < holes.size();) {
    const std::size_t end = holes.find('\n', begin) + 1;
    std::string row = holes.substr(begin, end - begin);
    if (++line % 7 == 0) {
      const std::size_t comma = row.find(',') + 1;
      row.replace(comma, row.find(',', comma) - comma, line % 2 == 0 ? "" : "nan");
    }
    with_holes += row + (line == 500 ? row : "");
    begin = end;
  }
  const log::Log holed = read(with_holes, config);
  for (const auto& [name, member] :
       {std::pair("u", &PoseLog::Sample::u), std::pair("v", &PoseLog::Sample::v)}) {
    const double plain_error = deviation(plain, name, truth, member);
    EXPECT_NEAR(deviation(turned, name, truth, member), plain_error, 1e-6);
    EXPECT_NEAR(deviation(holed, name, truth, member), plain_error, 3e-3);
  }
}

TEST_F(PoseConfig, RefusesWhatIsNoPose) {
  const std::string csv = PoseLog(30.0).csv(0.0);
  EXPECT_NE(
      refusal(csv, "[log]\ntime = \"t\"\nrate = 5\npose = [\"x\", \"n\"]\n").find("'n' names no"),
      std::string::npos);
  EXPECT_NE(refusal(csv, "[log]\ntime = \"t\"\nrate = 5\npose = {x = \"x\"}\n").find("x and y"),
            std::string::npos);
  EXPECT_NE(refusal(csv, "[log]\ntime = \"t\"\nrate = 5\npose = {x = \"x\", yau = \"psi\"}\n")
                .find("yaw"),
            std::string::npos);
  EXPECT_NE(refusal(csv, kPlane + "window = -1\n" + kCommands).find("window"), std::string::npos);
  const std::string lever =
      "lever_arm = {velocity = [\"u\", \"v\", \"w\"], rates = [\"p\", \"q\", \"r\"], arm = [1, 0, "
      "0]}\n";
  EXPECT_NE(refusal(csv, kPlane + lever + kCommands).find("pose of that point"), std::string::npos);
  EXPECT_NE(refusal("t,x,y,psi,n\n0,1,2,3,4\n1,1,2,3,4\n2,1,2,3,4\n",
                    kPlane + "[log.commands]\nn = \"n\"\n")
                .find("window"),
            std::string::npos);
  const auto option = [&](const log::Roles& roles) {
    return testing::message_of<InputError>(
        [&] { log::read_log({.path = write("log.csv", csv)}, {}, roles); });
  };
  EXPECT_NE(option({.pose = {"x", "y", "bearing"}}).find("bearing"), std::string::npos);
  EXPECT_NE(option({.pose = {"n"}}).find("names no part of a pose"), std::string::npos);
  EXPECT_NE(option({.inputs = {"n"}, .time = "clock", .pose = {"x", "y", "psi"}}).find("clock"),
            std::string::npos);
}

// Positions are no columns of the rows; their units are used up where poses become velocities.
TEST_F(PoseConfig, AHeaderWithUnitsIsAsGoodAsOneWithout) {
  std::string csv = PoseLog(120.0).csv(0.001);
  csv.replace(0, csv.find('\n'), "time,north [cm],east [cm],heading [rad],thruster1,thruster2");
  const log::Log guessed = log::read_log({.path = write("pose.csv", csv)}, {}, {});
  const log::Dataset data = guessed.dataset();
  EXPECT_EQ(data.target_names, (Names{"udot", "vdot", "rdot"}));
  EXPECT_EQ(data.input_names, (Names{"u", "v", "r", "thruster1", "thruster2"}));
  csv.replace(0, csv.find('\n'), "time,north [m],east [m],heading [rad],thruster1,thruster2");
  const log::Log metres = log::read_log({.path = write("pose.csv", csv)}, {}, {});
  EXPECT_NEAR(100.0 * column(guessed, "u")[200], column(metres, "u")[200], 0.05);
  const log::Log told = read(csv,
                             "[log]\ntime = \"time\"\nrate = 5\n"
                             "pose = {x = \"north\", y = \"east\", yaw = \"heading\"}\n"
                             "units = {x = \"m\"}\n"
                             "[log.commands]\nn = \"thruster1\"\nm = \"thruster2\"\n");
  EXPECT_EQ(told.dataset().target_names, (Names{"udot", "vdot", "rdot"}));
}

}  // namespace
}  // namespace kelpie::draft_pose_test
