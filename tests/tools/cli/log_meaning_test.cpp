// SPDX-License-Identifier: Apache-2.0
// What a log says by itself: its clock, its roles, its validity, its frames; each kind at the door
// of `kelpie learn`.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

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
      const Outcome outcome =
          run("learn log.csv --set preset=paper --set buffer=50 --out out " + one.options);
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

}  // namespace
}  // namespace kelpie::log_meaning_test
