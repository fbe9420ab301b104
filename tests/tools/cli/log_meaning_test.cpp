// SPDX-License-Identifier: Apache-2.0
// What a log says by itself: its clock, its roles, its validity, its frames; each kind at the door
// of `kelpie learn`.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "bag/mcap_writer.hpp"
#include "bag/message_builder.hpp"
#include "cli/command.hpp"

namespace kelpie::log_meaning_test {
namespace {

using testing::Outcome;

// A row of the log: two minutes of a boat with two thrusters, at 5 Hz.
struct Row {
  int k = 0;
  double t = 0.0;
  double u = 0.0, v = 0.0, r = 0.0;
  double n1 = 0.0, n2 = 0.0;
  double x = 0.0, y = 0.0, psi = 0.3;
};

std::vector<Row> drive(double step_s, int rows) {
  std::vector<Row> all;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::normal_distribution<double> normal(0.0, 0.002);
  Row now;
  double until_s = 0.0;
  for (; now.k < rows; ++now.k) {
    if (now.t >= until_s) {
      now.n1 = uniform(random);
      now.n2 = uniform(random);
      until_s = now.t + 2.5 + 1.5 * uniform(random);
    }
    all.push_back(now);
    all.back().u += normal(random);
    all.back().v += normal(random);
    all.back().r += normal(random);
    const double port = now.n1 * std::abs(now.n1);
    const double starboard = now.n2 * std::abs(now.n2);
    now.x += step_s * (now.u * std::cos(now.psi) - now.v * std::sin(now.psi));
    now.y += step_s * (now.u * std::sin(now.psi) + now.v * std::cos(now.psi));
    now.psi += step_s * now.r;
    const double u = now.u;
    now.u += step_s * (0.6 * (port + starboard) - 0.5 * u - 0.8 * u * std::abs(u) + now.v * now.r);
    now.v += step_s * (-0.8 * now.v - 0.6 * u * now.r);
    now.r += step_s * (0.9 * (starboard - port) - 1.1 * now.r);
    now.t += step_s;
  }
  return all;
}

using Cell = std::function<std::string(const Row&)>;
using Columns = std::vector<std::pair<std::string, Cell>>;

Cell number(double Row::*member, double scale = 1.0) {
  return [=](const Row& row) { return fmt::format("{:.8g}", scale * row.*member); };
}

const Columns kBoat{{"u", number(&Row::u)},
                    {"v", number(&Row::v)},
                    {"r", number(&Row::r)},
                    {"n1", number(&Row::n1)},
                    {"n2", number(&Row::n2)}};

std::string log_of(const Columns& columns, const std::string& separator = ",", double step_s = 0.2,
                   int rows = 600) {
  std::string text;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    text += (k > 0 ? separator : "") + columns[k].first;
  }
  text += "\n";
  for (const Row& row : drive(step_s, rows)) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      text += (k > 0 ? separator : "") + columns[k].second(row);
    }
    text += "\n";
  }
  return text;
}

// The boat with a column of time before, and further columns behind.
std::string boat(const std::string& time, const Cell& cell, const Columns& more = {}) {
  Columns columns{{time, cell}};
  columns.insert(columns.end(), kBoat.begin(), kBoat.end());
  columns.insert(columns.end(), more.begin(), more.end());
  return log_of(columns);
}

// The number of the row as a time of day, beginning so many seconds after midnight.
std::string clock(int k, double begin_s) {
  const double s = begin_s + 0.2 * k;
  const int whole = static_cast<int>(s);
  return fmt::format("{:02d}:{:02d}:{:04.1f}", whole / 3600 % 24, whole / 60 % 60,
                     std::fmod(s, 60.0));
}

struct Case {
  std::string log;
  std::string options;
  int exit_code = 0;
  std::string message;  // on stdout or stderr
};

class LogMeaning : public testing::CommandTest {
 protected:
  void expect(const std::vector<Case>& cases) {
    for (const Case& one : cases) {
      write("log.csv", one.log);
      const Outcome outcome = run(
          "learn log.csv --align none --set preset=paper --set buffer=50 --out out " + one.options);
      const std::string head = one.log.substr(0, one.log.find('\n', one.log.find('\n') + 1));
      EXPECT_EQ(outcome.exit_code, one.exit_code) << head << "\n" << outcome.err;
      EXPECT_NE((outcome.out + outcome.err).find(one.message), std::string::npos)
          << one.message << "\nof: " << head << " " << one.options << "\n"
          << outcome.out << outcome.err;
    }
  }
};

constexpr const char* kTwoMinutes = "(2 min at 5 Hz)";

TEST_F(LogMeaning, TimeInWords) {
  const auto words = [](const std::string& text, double begin_s) {
    return [=](const Row& row) { return text + clock(row.k, begin_s); };
  };
  expect({
      {boat("Time", [](const Row& row) { return fmt::format("{:.5g} sec", row.t); }), "", 0,
       kTwoMinutes},
      {boat("Time", words("", 47220.0)), "", 0, kTwoMinutes},
      {boat("Time", words("", 86390.0)), "", 0, kTwoMinutes},
      {boat("Time", words("01-May-2023 ", 0.0)), "", 0, kTwoMinutes},
      {boat("Time", words("1 days ", 0.0)), "", 0, kTwoMinutes},
      {boat("time", words("01/20/2021 ", 0.0)), "", 0, kTwoMinutes},
      {boat("time", words("20.01.2021 ", 0.0)), "", 0, kTwoMinutes},
      {boat("time", words("01/02/2021 ", 0.0)), "", 2,
       "time holds '01/02/2021 00:00:00.0', which may have the day or the month first"},
      {boat("Time", [](const Row& row) { return fmt::format("tick {}", row.k); }), "", 2,
       "Time holds 'tick 0' (line 2): times are read in s"},
      {boat("Time", [](const Row& row) { return fmt::format("tick {}", row.k); }), "--rate 5", 0,
       kTwoMinutes},
  });
}

TEST_F(LogMeaning, TimeInNumbers) {
  const auto of = [](double scale, double begin, int most_digits) {
    return
        [=](const Row& row) { return fmt::format("{:.{}f}", begin + scale * row.k, most_digits); };
  };
  const auto folded = [](double end) {
    return
        [=](const Row& row) { return fmt::format("{:.1f}", std::fmod(end - 60.0 + row.t, end)); };
  };
  const auto an_hour_back = [](const Row& row) {
    return "2021-10-31 " + clock(row.k, row.k < 300 ? 10740.0 : 7140.0);
  };
  expect({
      {boat("timestamp", of(200.0, 1.7e12, 0)), "", 0, "timestamp: read in ms, as its size tells"},
      {boat("%time", of(2e8, 1.7e18, 0)), "", 0, kTwoMinutes},
      {boat("Time", of(0.2 / 86400.0, 45047.5, 10)), "", 0, kTwoMinutes},
      {boat("Time", of(0.2 / 86400.0, 738000.0, 10)), "", 0, kTwoMinutes},
      {boat("time_ms", of(200.0, 0.0, 0)), "", 0, kTwoMinutes},
      {boat("time", of(0.2 / 86400.0, 0.0, 10)), "--units time=d", 0, kTwoMinutes},
      {boat("time", of(200.0, 0.0, 0)), "", 2, "--units time=ms says that it is in ms"},
      {boat("Time", folded(86400.0)), "", 2,
       "time runs backwards, from 86399.8 (line 301) to 0 s; a midnight?"},
      {boat("gps_tow", folded(604800.0)), "", 2, "a new week of GPS?"},
      {boat("time", an_hour_back), "", 2, "an hour, as at the end of summer time?"},
  });
  // Milliseconds since the boot count as whole seconds of a vehicle that hardly moves.
  Columns fast{{"time", [](const Row& row) { return std::to_string(5 * row.k); }}};
  fast.insert(fast.end(), kBoat.begin(), kBoat.end());
  const std::string at_200_hz = log_of(fast, ",", 0.005, 12000);
  expect(
      {{at_200_hz, "", 2, "one row each 5 s, in which velocities hardly change: --units time=ms"},
       {at_200_hz, "--units time=ms", 0, "(48 s at 16 Hz)"}});
  fast[0].second = [](const Row& row) { return std::to_string(row.k); };
  expect({{log_of(fast, ",", 1.0 / 3.0, 400), "", 0, "at 1 Hz"}});
}

TEST_F(LogMeaning, TimeByOption) {
  const std::string zeit = boat("Uhr", number(&Row::t));
  expect({{zeit, "", 2, "--time names the column, or --rate gives the rows per second"},
          {zeit, "--time Uhr", 0, kTwoMinutes},
          {log_of(kBoat), "--rate 5", 0, kTwoMinutes}});
  const Outcome looked = testing::succeeded(run("inspect log.csv --rate 5 --template t.toml"));
  EXPECT_NE(looked.out.find("5 rows per second"), std::string::npos) << looked.out;
  for (const std::string command :
       {"learn log.csv --config t.toml", "identify log.csv --rate 5",
        "tune log.csv --rate 5 --trials 1 --quick", "live --replay log.csv --rate 5 --speed max"}) {
    const Outcome outcome = run(command + " --out of_rate");
    EXPECT_EQ(outcome.err.find("time"), std::string::npos) << command << "\n" << outcome.err;
  }
}

// Dropped rows and cells do not change the rate.
TEST_F(LogMeaning, RowsThatAreMissing) {
  std::string dropped;
  std::size_t line = 0;
  const std::string whole = boat("t", number(&Row::t));
  for (std::size_t begin = 0; begin < whole.size();) {
    const std::size_t end = whole.find('\n', begin) + 1;
    dropped += ++line > 1 && line % 5 == 0 ? "" : whole.substr(begin, end - begin);
    begin = end;
  }
  expect({{dropped, "", 0, kTwoMinutes}, {dropped, "", 0, "u = u (5 Hz"}});
}

TEST_F(LogMeaning, FilesThatLossOfPowerEnded) {
  const std::string log = boat("t", number(&Row::t));
  const std::string cut = log.substr(0, log.rfind(','));
  const std::string nul = log + std::string(500, '\0');
  std::string commas = log;
  for (std::size_t end = 0; (end = commas.find('\n', end)) != std::string::npos; end += 2) {
    commas.insert(end, ",");
  }
  expect({{cut, "", 2, "log.csv:601: 5 cells in this row; the header has 6: the file ends within"},
          {cut, "--recover", 0, "log.csv:601: is cut off; left out"},
          {nul, "", 2, "ends in 500 NUL bytes, as after a loss of power; --recover reads what"},
          {nul, "--recover", 0, "500 NUL bytes at the end; left out"},
          {log + log.substr(0, log.find('\n') + 1), "--recover", 0,
           "log.csv:602: is the header again; left out"},
          {commas, "", 2, "column 7: has no name"},
          {commas, "--recover", 0, "log.csv:1: ends in an empty column; left out"}});
}

TEST_F(LogMeaning, UnitsInNames) {
  const double knots = 1.0 / 0.514444;
  const std::string log = log_of({{"t", number(&Row::t)},
                                  {"surge_kn", number(&Row::u, knots)},
                                  {"sway_m_s", number(&Row::v)},
                                  {"yaw_deg_s", number(&Row::r, 57.29578)},
                                  {"x_m", number(&Row::x)},
                                  {"y_m", number(&Row::y)},
                                  {"yaw_deg", number(&Row::psi, 57.29578)},
                                  {"n1", number(&Row::n1)},
                                  {"n2", number(&Row::n2)}});
  expect({{log, "", 0, "u = surge_kn (knots, 5 Hz"},
          {log, "", 0, "r = yaw_deg_s (deg/s, 5 Hz"},
          {log, "", 0, "psi = yaw_deg (deg, 5 Hz"},
          {log, "", 0, "commands: n1, n2\n"},
          {log, "--pose x_m,y_m,yaw_deg", 0, kTwoMinutes}});
  // Poses that are named count in the units of the header, as poses that are found.
  write("log.csv", log_of({{"t", number(&Row::t)},
                           {"x [cm]", number(&Row::x, 100.0)},
                           {"y [cm]", number(&Row::y, 100.0)},
                           {"psi", number(&Row::psi)},
                           {"n1", number(&Row::n1)},
                           {"n2", number(&Row::n2)}}));
  const auto axes = [&](const std::string& options) {
    testing::succeeded(run("learn log.csv --out out" + testing::kFewSamples + options));
    std::vector<double> r2;
    for (const auto& axis : parsed("out/result.json")["axes"]) {
      r2.push_back(axis["r2"]["final"]);
    }
    return r2;
  };
  EXPECT_EQ(axes(" --pose x,y,psi"), axes(""));
}

TEST_F(LogMeaning, TablesOfOtherPrograms) {
  const Columns timed = [] {
    Columns columns{{"t", number(&Row::t)}};
    columns.insert(columns.end(), kBoat.begin(), kBoat.end());
    return columns;
  }();
  const std::string commas = log_of(timed);
  const std::string blanks = log_of(timed, " ");
  std::string mixed = commas;
  std::ranges::replace(mixed.begin() + 14, mixed.end(), ',', ';');
  expect({
      {"# " + commas, "", 0, kTwoMinutes},
      {"% a boat\n% " + commas, "", 0, kTwoMinutes},
      {"# " + blanks, "", 0, kTwoMinutes},
      {log_of(timed, "   "), "", 0, kTwoMinutes},
      {"# t,u,v\n" + commas.substr(commas.find('\n') + 1), "", 2,
       "it has to name the columns, as in u,v,r, or as many as the row has cells (6)"},
      {mixed, "", 2, "1 cells in this row; the header has 6: they are separated by ';'"},
      {"t,u,n\n0,2,0,1,0,3\n", "", 2, "decimal commas? Separate cells by ';'"},
      {commas + commas, "", 2, "log.csv:602: is the header again: two logs in one file?"},
      {"<!DOCTYPE html>\n", "", 2, "is HTML or XML"},
      {"{\"format\": 1}\n", "", 2, "a model of `kelpie learn` is taken by --model or --from"},
      {"\xFF\xD8\xFF\xE0", "", 2, "is a picture (JPEG)"},
  });
}

TEST_F(LogMeaning, RolesByReason) {
  const auto noise = [](double rate) {
    return [=](const Row& row) { return fmt::format("{:.4f}", 40.0 + std::sin(rate * row.k)); };
  };
  const auto with = [&](const std::string& names) {
    Columns more;
    for (const std::string& name : testing::words_of(names)) {
      more.emplace_back(name, noise(1.0 + 0.1 * static_cast<double>(more.size())));
    }
    return boat("t", number(&Row::t), more);
  };
  const std::string commands = "commands: n1, n2\n";
  expect({
      {with("T_motor m_nb_sat motor_controller_humidity usv_control/sast/x_gain az_mps2 "
            "thruster_manager/rssi motor_driver/board/leak control/reference/heading n_sats"),
       "", 0, commands},
      {with("m_depth m_pitch m_vacuum"), "", 0, commands},
      {with("thr_ref1 motor_aft/cmd"), "", 0, "commands: motor_aft_cmd, n1, n2, thr_ref1\n"},
  });
  // Beside accelerations every column may be an input, but no other value of a velocity or command.
  std::vector<Row> rows = drive(0.2, 600);
  const auto slope = [&](double Row::*of) {
    return [&rows, of](const Row& row) {
      const auto k = static_cast<std::size_t>(std::clamp(row.k, 1, 598));
      return fmt::format("{:.6f}", (rows[k + 1].*of - rows[k - 1].*of) / 0.4);
    };
  };
  const auto next = [&](const Row& row) {
    return fmt::format("{:.6f}", rows[static_cast<std::size_t>(std::min(row.k + 1, 599))].u);
  };
  const std::string ready = boat("t", number(&Row::t),
                                 {{"udot", slope(&Row::u)},
                                  {"rdot", slope(&Row::r)},
                                  {"true_udot", slope(&Row::u)},
                                  {"tv_u", number(&Row::u)},
                                  {"u_next", next},
                                  {"later", next},
                                  {"act_n1", number(&Row::n1, 0.9)},
                                  {"x_gain", noise(1.0)},
                                  {"wave", noise(1.1)}});
  expect({{ready, "", 0, "commands: n1, n2, wave\n"},
          {ready, "", 0, "u_next: is left out of the inputs: u of another row; --inputs takes it"},
          {ready, "", 0, "later: is left out of the inputs: goes with u, read 1 rows later"}});
}

TEST_F(LogMeaning, AccelerationsBesideVelocities) {
  const std::vector<Row> rows = drive(0.2, 600);
  const auto slope = [&](double Row::*of, double factor, double offset) {
    return [&rows, of, factor, offset](const Row& row) {
      const auto k = static_cast<std::size_t>(std::clamp(row.k, 1, 598));
      return fmt::format("{:.6f}", offset + factor * (rows[k + 1].*of - rows[k - 1].*of) / 0.4);
    };
  };
  const auto log = [&](double Row::*u, double Row::*v, double offset, double turn) {
    return log_of({{"t", number(&Row::t)},
                   {"u", number(u)},
                   {"v", number(v)},
                   {"r", number(&Row::r, turn)},
                   {"n1", number(&Row::n1)},
                   {"n2", number(&Row::n2)},
                   {"udot", slope(&Row::u, 1.0, 0.0)},
                   {"vdot", slope(&Row::v, 1.0, offset)},
                   {"rdot", slope(&Row::r, turn, 0.0)}});
  };
  const double degrees = 57.29578;
  expect({{log(&Row::u, &Row::v, 0.0, 1.0), "", 0, "R²"},
          {log(&Row::v, &Row::u, 0.0, 1.0), "", 2, "udot is the acceleration of v, not of u"},
          {log(&Row::u, &Row::v, 0.3, 1.0), "", 0, "standard deviations beside the slope of v"},
          {log(&Row::u, &Row::v, 0.0, degrees), "", 2,
           "rad/s, as of hardly any vehicle; --units r=deg/s"},
          {log(&Row::u, &Row::v, 0.0, degrees), "--units r=deg/s,rdot=deg/s^2", 0, "R²"}});
  write("log.csv", log(&Row::u, &Row::v, 0.0, degrees));
  testing::expect_refused(run("identify log.csv --out out"), "rad/s, as of hardly any vehicle");
}

TEST_F(LogMeaning, VelocitiesThatAreNotMeasured) {
  const auto is_out = [](const Row& row) { return row.k % 150 > 120; };
  const auto unless = [=](double Row::*of, const std::string& mark) {
    return [=](const Row& row) { return is_out(row) ? mark : fmt::format("{:.6f}", row.*of); };
  };
  const auto log = [&](const std::string& mark, const Columns& more = {}) {
    Columns columns{{"t", number(&Row::t)},       {"u", unless(&Row::u, mark)},
                    {"v", unless(&Row::v, mark)}, {"r", number(&Row::r)},
                    {"n1", number(&Row::n1)},     {"n2", number(&Row::n2)}};
    columns.insert(columns.end(), more.begin(), more.end());
    return log_of(columns);
  };
  const auto flag = [&](const std::string& valid, const std::string& invalid) {
    return [=](const Row& row) { return is_out(row) ? invalid : valid; };
  };
  const std::string held = "0.01";  // a value that nothing but the flag tells from a measurement
  expect({
      {log(held, {{"velocity_valid", flag("1", "0")}}), "", 0,
       "velocity_valid calls velocities invalid in 116 rows, the first on line 123: u, v are not"},
      {log(held, {{"bottom_lock", flag("True", "False")}}), "", 0,
       "calls velocities invalid in 116"},
      {log(held, {{"dvl_invalid", flag("0", "1")}}), "", 0, "calls velocities invalid in 116"},
      {log(held, {{"fom", flag("0.002", "9.9")}}), "", 0, "calls velocities invalid in 116"},
      {log("-32.768"), "", 0, "u: -32.768, a sensor's mark of no value, in 116 rows"},
      {log("-999"), "", 0, "v: -999, a sensor's mark of no value, in 116 rows"},
      {log("77.7"), "", 0, "u: 77.7, a sensor's mark of no value, in 116 rows"},
      {log("0"), "", 0, "exact zeros between rows of a moving vehicle in"},
      {log("-999"), "--missing none", 0, "R²"},
      {log("0.5"), "--missing u=0.5,v=0.5", 0, "R²"},
      {log("0.5"), "--missing u=half", 2, "'u=half' is no number; write -999, u=-999, or none"},
      {log(held, {{"velocity_valid", [](const Row&) { return "0"; }}}), "", 2,
       "no velocity was measured: velocity_valid calls velocities invalid in every row"},
  });
}

TEST_F(LogMeaning, VelocitiesBesidePoses) {
  const auto turned = [](double angle, bool is_of_u) {
    return [=](const Row& row) {
      const double own = is_of_u ? std::cos(angle) * row.u - std::sin(angle) * row.v
                                 : std::sin(angle) * row.u + std::cos(angle) * row.v;
      return fmt::format("{:.6f}", own);
    };
  };
  const auto of_world = [](bool is_of_x) {
    return [=](const Row& row) {
      const double own = is_of_x ? std::cos(row.psi) * row.u - std::sin(row.psi) * row.v
                                 : std::sin(row.psi) * row.u + std::cos(row.psi) * row.v;
      return fmt::format("{:.6f}", own);
    };
  };
  const auto log = [](const Cell& u, const Cell& v, const Cell& r) {
    return log_of({{"t", number(&Row::t)},
                   {"x", number(&Row::x)},
                   {"y", number(&Row::y)},
                   {"psi", number(&Row::psi)},
                   {"u", u},
                   {"v", v},
                   {"r", r},
                   {"n1", number(&Row::n1)},
                   {"n2", number(&Row::n2)}});
  };
  const Cell u = number(&Row::u);
  const Cell v = number(&Row::v);
  const Cell r = number(&Row::r);
  expect({
      {log(u, v, r), "", 0, kTwoMinutes},
      {log(of_world(true), of_world(false), r), "", 2,
       "u and v are velocities along the axes of the world, not of the vehicle"},
      {log(of_world(true), of_world(false), r), "--pose x,y,psi", 0, "R²"},
      {log(of_world(true), of_world(false), r), "--accept implausible", 0, kTwoMinutes},
      {log(number(&Row::u, 100.0), number(&Row::v, 100.0), r), "", 2, "--units u=cm/s,v=cm/s"},
      {log(number(&Row::u, 100.0), number(&Row::v, 100.0), r), "--units u=cm/s,v=cm/s", 0,
       kTwoMinutes},
      {log(u, v, number(&Row::r, -1.0)), "", 2, "r has the sign opposite to the slope of psi"},
      {log(u, v, number(&Row::r, 57.29578)), "", 2, "--units r=deg/s converts"},
      {log(v, u, r), "", 2, "u and v are exchanged"},
      {log(turned(0.7854, true), turned(0.7854, false), r), "", 0,
       "the ways between poses lie -45 degrees beside u and v"},
  });
}

// Commands that come so much later than they were given, six minutes of them.
TEST_F(LogMeaning, CommandsOfAnotherClock) {
  const std::vector<Row> rows = drive(0.2, 1800);
  const auto log = [&](double late_s) {
    const auto late = [&rows, late_s](double Row::*of) {
      return [&rows, of, late_s](const Row& row) {
        const int from = row.k - static_cast<int>(std::lround(late_s / 0.2));
        return fmt::format("{:.6f}", rows[static_cast<std::size_t>(std::clamp(from, 0, 1799))].*of);
      };
    };
    return log_of({{"t", number(&Row::t)},
                   {"u", number(&Row::u)},
                   {"v", number(&Row::v)},
                   {"r", number(&Row::r)},
                   {"n1", late(&Row::n1)},
                   {"n2", late(&Row::n2)}},
                  ",", 0.2, 1800);
  };
  expect({{log(0.0), "", 0, "(5 min at 5 Hz)"},
          {log(1.6), "", 0, "(5 min at 5 Hz)"},
          {log(10.0), "", 2, "the commands come 10 s late"},
          {log(10.0), "", 2, "the two have different clocks; --align 10 takes them so"},
          {log(-8.0), "", 2, "the commands come 8 s early"},
          {log(20.0), "", 2, "or their messages by lag = 19.8 in [log]"}});
  write("log.csv", log(10.0));
  testing::succeeded(run("learn log.csv --align 10 --set preset=paper --set buffer=50 --out out"));
  EXPECT_NE(testing::succeeded(run("inspect log.csv")).out.find("the commands come 10 s late"),
            std::string::npos);
}

// Accelerations, so that every other column may be an input.
TEST_F(LogMeaning, SecondSetsForTheSameThrusters) {
  const std::vector<Row> rows = drive(0.2, 600);
  const Cell udot = [&rows](const Row& row) {
    const auto k = static_cast<std::size_t>(std::clamp(row.k, 1, 598));
    return fmt::format("{:.6f}", (rows[k + 1].u - rows[k - 1].u) / 0.4);
  };
  const auto with = [&](const std::vector<std::pair<std::string, Cell>>& commands) {
    Columns columns{{"t", number(&Row::t)}, {"u", number(&Row::u)}, {"udot", udot}};
    columns.insert(columns.end(), commands.begin(), commands.end());
    return log_of(columns);
  };
  const auto of = [](double Row::*n, auto function) {
    return [=](const Row& row) { return fmt::format("{:.6f}", function(row.*n, 0.3 * row.t)); };
  };
  const auto azimuth = [](double, double t) { return std::sin(t); };
  const auto along = [](double n, double t) { return n * std::abs(n) * std::cos(std::sin(t)); };
  const auto across = [](double n, double t) { return n * std::abs(n) * std::sin(std::sin(t)); };
  const auto pulse = [](double n, double) { return 1500.0 + 400.0 * n; };
  const auto wish = [](double n, double t) { return n + std::sin(7.0 * t); };
  const Columns speeds{{"rpm1", number(&Row::n1)}, {"rpm2", number(&Row::n2)}};
  Columns azimuths = speeds;
  azimuths.insert(azimuths.end(),
                  {{"az1", of(&Row::n1, azimuth)},
                   {"az2", of(&Row::n2, [](double, double t) { return std::cos(t); })},
                   {"fx1", of(&Row::n1, along)},
                   {"fx2", of(&Row::n2, along)},
                   {"fy1", of(&Row::n1, across)},
                   {"fy2", of(&Row::n2, across)}});
  Columns twice = speeds;
  twice.insert(twice.end(), {{"motor_pwm1", of(&Row::n1, pulse)},
                             {"motor_pwm2", of(&Row::n2, pulse)},
                             {"thr_ref1", of(&Row::n1, wish)},
                             {"thr_ref2", of(&Row::n2, wish)},
                             {"servo1", of(&Row::n2, azimuth)},
                             {"servo2", of(&Row::n1, across)}});
  expect({{with(azimuths), "", 0, "commands: fx1, fx2, fy1, fy2\n"},
          {with(azimuths), "", 0, "az2: is left out of the inputs: a second set for the thrusters"},
          {with(twice), "", 0, "commands: rpm1, rpm2, servo1, servo2\n"},
          {with(twice), "", 0, "motor_pwm1: is left out of the inputs: a second set for the"}});
}

TEST_F(LogMeaning, FrozenVelocities) {
  const std::vector<Row> rows = drive(0.2, 600);
  const auto frozen = [&rows](double Row::*of, int first, int last) {
    return [&rows, of, first, last](const Row& row) {
      const int k = row.k >= first && row.k < last ? first : row.k;
      return fmt::format("{:.6f}", rows[static_cast<std::size_t>(k)].*of);
    };
  };
  const auto log = [&](const Cell& u, const Cell& r) {
    return log_of({{"t", number(&Row::t)},
                   {"u", u},
                   {"v", number(&Row::v)},
                   {"r", r},
                   {"n1", number(&Row::n1)},
                   {"n2", number(&Row::n2)}});
  };
  const std::string of_surge = log(frozen(&Row::u, 200, 260), number(&Row::r));
  expect({{of_surge, "", 0, " in 59 rows, the first on line 203: u is not measured there"},
          {of_surge, "--missing none", 0, "R²"},
          {log(number(&Row::u), frozen(&Row::r, 400, 600)), "", 0, "r: frozen at"}});
  write("log.csv", log(number(&Row::u), number(&Row::r)));
  const Outcome sound = testing::succeeded(run("inspect log.csv"));
  EXPECT_EQ((sound.out + sound.err).find("frozen"), std::string::npos);
}

TEST_F(LogMeaning, GravityInAnAcceleration) {
  const std::vector<Row> rows = drive(0.2, 600);
  const auto log = [&](double gravity) {
    const Cell udot = [&rows, gravity](const Row& row) {
      const auto k = static_cast<std::size_t>(std::clamp(row.k, 1, 598));
      return fmt::format("{:.6f}", (rows[k + 1].u - rows[k - 1].u) / 0.4 +
                                       gravity * std::sin(0.1 * std::sin(0.8 * row.t)));
    };
    return log_of(
        {{"t", number(&Row::t)},
         {"u", number(&Row::u)},
         {"n1", number(&Row::n1)},
         {"n2", number(&Row::n2)},
         {"theta",
          [](const Row& row) { return fmt::format("{:.6f}", 0.1 * std::sin(0.8 * row.t)); }},
         {"udot", udot}});
  };
  expect({{log(0.0), "", 0, kTwoMinutes},
          {log(9.81), "", 2, "times the sine of theta: a specific force with gravity"},
          {log(9.81), "--ignore udot", 0, kTwoMinutes}});
}

TEST_F(LogMeaning, ShortLogsOfPoses) {
  const auto log = [](double step_s, int rows) {
    return log_of({{"t", number(&Row::t)},
                   {"x", number(&Row::x)},
                   {"y", number(&Row::y)},
                   {"psi", number(&Row::psi)},
                   {"n1", number(&Row::n1)},
                   {"n2", number(&Row::n2)}},
                  ",", step_s, rows);
  };
  write("log.csv", log(0.02, 1500));
  testing::succeeded(run("inspect log.csv --template fast.toml"));
  EXPECT_NE(content("fast.toml").find("\nrate = 10 "), std::string::npos);
  write("log.csv", log(4.0, 150));
  testing::expect_refused(run("learn log.csv --out out"),
                          "poses come every 4 s, which takes a window of 28 s at least");
}

// A word beyond "fair" is earned.
TEST_F(LogMeaning, WordsOfTheVerdict) {
  Columns timed{{"t", number(&Row::t)}};
  timed.insert(timed.end(), kBoat.begin(), kBoat.end());
  const auto percent = [](double Row::*of) {
    return [of](const Row& row) { return fmt::format("{:.0f}%", 100.0 * row.*of); };
  };
  const std::vector<Row> rows = drive(0.2, 600);
  const Cell slope = [&rows](const Row& row) {
    const auto k = static_cast<std::size_t>(std::clamp(row.k, 1, 598));
    return fmt::format("{:.6f}", (rows[k + 1].u - rows[k - 1].u) / 0.4);
  };
  const std::string answer = boat("t", number(&Row::t), {{"udot", slope}, {"true_udot", slope}});
  write("log.csv", log_of(timed));
  const Outcome sound = testing::succeeded(run("learn log.csv --out out"));
  EXPECT_NE(sound.out.find("good"), std::string::npos) << sound.out;
  EXPECT_EQ(sound.out.find("WARNING"), std::string::npos) << sound.out;
  expect({{log_of(timed, ",", 0.2, 130), "--set warmup=50", 0, "R² says little of other drives"},
          {log_of(timed), "--split random", 0, "R² says little of other drives"},
          {log_of({{"t", number(&Row::t)},
                   {"u", number(&Row::u)},
                   {"udot", slope},
                   {"n1", percent(&Row::n1)}}),
           "", 0, "no commands are among the inputs"},
          {answer, "--inputs u,v,r,n1,n2,true_udot", 0,
           "the answer is among the inputs: true_udot goes with udot"}});
  EXPECT_EQ(content("out/report.html").find("good"), std::string::npos);
}

// A yaw rate with another sign turns sway's coupling round.
TEST_F(LogMeaning, NoVehicleIsIdentifiedBelowTheMean) {
  const auto log = [](double sign) {
    return log_of({{"t", number(&Row::t)},
                   {"u", number(&Row::u)},
                   {"v", number(&Row::v)},
                   {"r", number(&Row::r, sign)},
                   {"n1", number(&Row::n1)},
                   {"n2", number(&Row::n2)}},
                  ",", 0.2, 3000);
  };
  write("log.csv", log(1.0));
  const Outcome sound = testing::succeeded(run("identify log.csv --mass 50 --out out"));
  EXPECT_NE(sound.out.find("R² of the identified vehicle on held-out rows: "), std::string::npos);
  EXPECT_NE(sound.out.find(" at worst, "), std::string::npos);
  EXPECT_TRUE(exists("out/gazebo.sdf"));
  write("log.csv", log(-1.0));
  testing::expect_refused(run("identify log.csv --mass 50 --out out"),
                          "no vehicle was identified: R² of vdot is -");
  EXPECT_FALSE(exists("out/gazebo.sdf"));
  testing::succeeded(run("identify log.csv --mass 50 --out out --accept implausible"));
}

// The boat as a recording: a message of `type` on `topic`, the thrusters, and `others`.
using Fill = std::function<void(bag::MessageBuilder&, const Row&)>;

std::string recording(const std::string& topic, const std::string& type, const Fill& fill,
                      const std::vector<std::string>& others = {}) {
  const bag::MessageDefinitions definitions;
  bag::McapWriter writer;
  std::vector<bag::MessageBuilder> builders;
  std::vector<std::string> names{topic, "/thrusters/left", "/thrusters/right"};
  names.insert(names.end(), others.begin(), others.end());
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string own = k == 0 ? type : "std_msgs/msg/Float64";
    writer.add_topic({.name = names[k], .type = own, .definition = definitions.full_text(own)});
    builders.emplace_back(definitions.type(own));
  }
  for (const Row& row : drive(0.2, 600)) {
    const auto time_ns = static_cast<std::int64_t>(1e9 * row.t);
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (k == 0) {
        fill(builders[k], row);
      } else {
        builders[k].set("data", k == 1 ? row.n1 : k == 2 ? row.n2 : std::sin(row.t));
      }
      writer.write({.topic = k,
                    .receive_ns = time_ns,
                    .publish_ns = time_ns,
                    .sequence = static_cast<std::uint32_t>(row.k),
                    .data = builders[k].bytes()});
    }
  }
  return writer.take() + writer.finish();
}

TEST_F(LogMeaning, Recordings) {
  const Fill dvl = [](bag::MessageBuilder& message, const Row& row) {
    const bool is_valid = row.k % 150 < 120;
    message.set("velocity.x", is_valid ? row.u : 0.01);
    message.set("velocity.y", is_valid ? row.v : 0.01);
    message.set("velocity_valid", is_valid ? 1.0 : 0.0);
  };
  // A mark of no value is rounded as other numbers are.
  const auto twist_or = [](double none) {
    return [none](bag::MessageBuilder& message, const Row& row) {
      const bool is_valid = row.k % 150 < 120;
      const double mark = none * (1.0 + 1e-5 * (row.k % 3));
      message.set("twist.linear.x", is_valid ? row.u : mark);
      message.set("twist.linear.y", is_valid ? row.v : mark);
      message.set("twist.angular.z", row.r);
    };
  };
  const Fill odometry = [](bag::MessageBuilder& message, const Row& row) {
    message.set("pose.pose.position.x", row.x);
    message.set("pose.pose.position.y", row.y);
    message.set("pose.pose.orientation.w", std::cos(row.psi / 2.0));
    message.set("pose.pose.orientation.z", std::sin(row.psi / 2.0));
    message.set("twist.twist.linear.x", row.u);
    message.set("twist.twist.linear.y", row.v);
    message.set("twist.twist.angular.z", row.r);
  };
  const Fill of_world = [&](bag::MessageBuilder& message, const Row& row) {
    odometry(message, row);
    message.set("twist.twist.linear.x", std::cos(row.psi) * row.u - std::sin(row.psi) * row.v);
    message.set("twist.twist.linear.y", std::sin(row.psi) * row.u + std::cos(row.psi) * row.v);
  };
  const Fill frozen = [&](bag::MessageBuilder& message, const Row& row) {
    twist_or(0.0)(message, {.u = row.u, .v = row.v, .r = row.r});
    message.set("twist.linear.x", row.k > 200 && row.k < 260 ? -0.9 : row.u);
  };
  const std::string commands = "commands: left, right\n";
  expect({
      {recording("/vel", "geometry_msgs/msg/TwistStamped", frozen), "", 0,
       "58 of 600 messages are no measurement of u"},
      {recording("/dvl/data", "dvl_msgs/msg/DVL", dvl), "", 0,
       "120 of 600 messages are no measurement of u"},
      {recording("/vel", "geometry_msgs/msg/TwistStamped", twist_or(0.0)), "", 0,
       "of 600 messages are no measurement of u"},
      {recording("/vel", "geometry_msgs/msg/TwistStamped", twist_or(-32.768)), "", 0,
       "120 of 600 messages are no measurement of v"},
      {recording("/odom", "nav_msgs/msg/Odometry", odometry,
                 {"/usv_control/sast/y_sigma", "/motor_driver/board/humidity",
                  "/thruster_manager/rssi", "/control/reference/heading"}),
       "", 0, commands},
      {recording("/boat/odometry", "nav_msgs/msg/Odometry", of_world), "", 0, commands},
  });
  testing::succeeded(run("inspect log.csv --template world.toml"));
  EXPECT_NE(content("world.toml").find("from = \"ENU\", to = \"FLU\""), std::string::npos);
}

}  // namespace
}  // namespace kelpie::log_meaning_test
