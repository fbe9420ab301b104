// SPDX-License-Identifier: Apache-2.0
// Typical mistakes of a first hour: docs/howto/first_hour.md has the same messages.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "cli/command.hpp"

namespace kelpie::mistakes_test {
namespace {

using testing::Outcome;

// A row of the log: five minutes of a vehicle in surge and yaw, at 5 Hz.
struct Row {
  double t = 0.0;
  double u = 0.0;
  double r = 0.0;
  double n = 0.0;
  double m = 0.0;
  double udot = 0.0;
  double rdot = 0.0;
};
using Rows = std::vector<Row>;

Rows drive() {
  constexpr double kStep = 0.2;
  constexpr int kRows = 1500;
  Rows rows;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  Row row;
  for (int i = 0; i < kRows; ++i) {
    row.n += (0.3 * normal(random) - row.n) * kStep;
    row.m += (0.3 * normal(random) - row.m) * kStep;
    row.udot = row.n - 0.3 * row.u + 0.002 * normal(random);
    row.rdot = row.m - 0.3 * row.r + 0.002 * normal(random);
    row.t = kStep * i;
    rows.push_back(row);
    row.u += kStep * row.udot;
    row.r += kStep * row.rdot;
  }
  return rows;
}

// The log after a change of every row; `more` columns behind, by row.
std::string csv(
    const std::function<void(Row&)>& change = [](Row&) {}, const std::string& head = "",
    const std::function<std::string(std::size_t)>& more = {}) {
  std::string text = "t,u,r,n,m,udot,rdot" + head + "\n";
  Rows rows = drive();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    change(rows[i]);
    const Row& row = rows[i];
    text += fmt::format("{},{},{},{},{},{},{}{}\n", row.t, row.u, row.r, row.n, row.m, row.udot,
                        row.rdot, more ? more(i) : "");
  }
  return text;
}

// Surge's accelerations come so many rows late.
std::string late_csv(std::size_t late) {
  const Rows rows = drive();
  std::size_t i = 0;
  return csv([&, late](Row& row) { row.udot = rows[std::max(late, i++) - late].udot; });
}

std::string without_time() {
  std::string text;
  const std::string all = csv();
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t end = all.find('\n', at);
    text += all.substr(all.find(',', at) + 1, end - all.find(',', at));
    at = end + 1;
  }
  return text;
}

std::string first_lines(const std::string& text, int lines) {
  std::size_t end = 0;
  for (int i = 0; i < lines; ++i) {
    end = text.find('\n', end) + 1;
  }
  return text.substr(0, end);
}

class Mistakes : public testing::CommandTest {
 protected:
  // The log has to be refused, or learned, with this message, which the page has as well.
  void expect(int exit_code, const std::string& log, const std::string& options,
              const std::string& message) {
    write("log.csv", log);
    expect_of(exit_code,
              "learn log.csv --quiet --set preset=paper --set buffer=50 --out out " + options,
              message);
  }
  void expect_of(int exit_code, const std::string& command, const std::string& message) {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, exit_code) << command << "\n" << outcome.err;
    EXPECT_NE((outcome.err + outcome.out).find(message), std::string::npos)
        << message << "\n"
        << outcome.err << outcome.out;
    EXPECT_NE(page_.find(message), std::string::npos) << "the page lacks: " << message;
  }

  const std::string page_ = testing::content_of(KELPIE_SOURCE_DIR "/docs/howto/first_hour.md");
};

TEST_F(Mistakes, Units) {
  expect(2, csv([](Row& row) { row.r *= 57.2958; }), "",
         "r is in degrees per second, rdot in rad/s²");
  expect(0, csv([](Row& row) { row.r *= 57.2958; }), "--units r=deg/s", "");
  expect(2, csv([](Row& row) { row.u *= 100.0; }), "", "u is in cm/s, udot in m/s²");
  expect(2, csv([](Row& row) { row.u *= 3.6; }), "", "u is in km/h, udot in m/s²");
  expect(2, csv([](Row& row) { row.u /= 0.514444; }), "", "u is in knots, udot in m/s²");
  expect(2, csv([](Row& row) { row.udot /= 9.80665; }), "", "udot is in g, u in m/s");
  expect(2, csv([](Row& row) { row.udot *= 7.0; }), "",
         "as large as the slope of u: the two have different units");
  expect(2, csv(), "--units r=rad/s2", "is not a unit such as m/s^2: a power is written with '^'");
}

TEST_F(Mistakes, SignsAndDelays) {
  expect(2, csv([](Row& row) { row.rdot *= -1.0; }), "",
         "rdot has the sign opposite to the slope of r: the axes of the two differ (NED and ENU, "
         "or FRD and FLU)");
  expect(2, late_csv(10), "", "udot comes 2 s later than u changes: the two have different clocks");
}

TEST_F(Mistakes, Clocks) {
  expect(2, csv([](Row& row) { row.t *= 1e3; }), "", "time stamps are in ms");
  expect(0, csv([](Row& row) { row.t *= 1e3; }), "--units t=ms", "");
  expect(2, csv([](Row& row) { row.t *= 1e9; }), "", "time stamps are in ns");
  expect(2, csv(), "--rate 2", "times as many rows per second as said; --rate 5");
  expect(2, csv([](Row& row) { row.t = std::floor(row.t); }), "",
         "stamps are rounded or rows are repeated: give the rows per second by --rate");
  expect(0, csv([](Row& row) { row.t = row.t > 100.0 && row.t < 102.0 ? 102.0 : row.t; }), "",
         "rows have the time stamp of the row before");
  expect(0, csv([](Row& row) { row.t += row.t > 150.0 ? 3600.0 : 0.0; }), "",
         "no rows for 60 min after 150 s");
  expect(0, csv([](Row& row) { row.t *= 1.0 / 400.0; }), "--accept implausible",
         "2000 rows per second are more than a vehicle's motion has to tell");
  expect(2, without_time(), "",
         "time: is unknown; name the time column with --time or give the "
         "rows per second with --rate");
  expect(2, csv([](Row& row) { row.t = std::fmod(row.t, 50.0); }), "",
         "time begins anew 5 times: give each run a file of its own");
  expect(2, csv(), "--rate 5 --time t", "--time excludes --rate");
  expect(2, csv(), "--rate -1", "--rate: '-1' has to be a number from 1e-06 to 1e+06");
  const std::string shuffled = first_lines(csv(), 500) + "3,0.1,0.1,0.1,0.1,0.1,0.1\n";
  expect(2, shuffled, "", "to 3 s; rows have to be in the order of time");
}

TEST_F(Mistakes, Columns) {
  const auto more = [](const std::string& cells) { return [cells](std::size_t) { return cells; }; };
  const auto of_row = [](double factor) {
    return [factor](std::size_t i) {
      return fmt::format(",{}", factor * std::sin(0.01 * static_cast<double>(i)));
    };
  };
  expect(0, csv([](Row&) {}, ",flag", more(",1")), "",
         "flag: is left out of the inputs: 1 in every row");
  expect(0, csv([](Row&) {}, ",flag", more(",1")), "--inputs u,r,n,m,flag",
         "flag: is left out of the inputs: 1 in every row");
  expect(0, csv([](Row&) {}, ",depth", of_row(9.0)), "",
         "depth: is left out of the inputs: a position");
  expect(0, csv([](Row&) {}, ",run", of_row(9.0)), "", "run: is left out of the inputs: a counter");
  expect(0, csv([](Row&) {}, ",condition", of_row(2.0)), "",
         "condition: is left out of the inputs: a label");
  expect(0, csv([](Row&) {}, ",heading", of_row(3.0)), "",
         "heading: is left out of the inputs: a heading");
  expect(0, csv([](Row&) {}, ",battery_v", of_row(16.0)), "",
         "battery_v: is left out of the inputs: of a battery");
  expect(0, csv([](Row&) {}, ",note", more(",dive 7")), "",
         "note: is left out of the inputs: 'dive 7' is not a number");
  expect(0, csv([](Row&) {}, ",vdot", more(",0")), "--ignore m",
         "m: is left out of the inputs: ignored, as asked");
  expect(2, csv(), "--ignore fin", "fin: there is no such column");
  expect(2, csv(), "--inputs u,r,n,l", "l: there is no such column");
  expect(2, csv([](Row& row) { row.udot = 0.0; }), "--targets udot",
         "udot: is 0 in every row: nothing to learn");
  const Rows rows = drive();
  expect(0, csv([](Row&) {}, ",copy", [&](std::size_t i) { return fmt::format(",{}", rows[i].n); }),
         "", "copy: is left out of the inputs: equals n in every row");
}

TEST_F(Mistakes, Files) {
  expect_of(2, "learn none.csv", "none.csv: cannot be read: No such file or directory");
  expect(2, "", "", "is empty; a header line that names the columns and rows of numbers are due");
  expect(2, first_lines(csv(), 1), "", "has a header but no rows");
  expect(2, "0,1,2\n1,2,3\n", "", "the first line holds only numbers; it has to name the columns");
  expect(2, "PK\x03\x04 sheet", "", "is a spreadsheet or a zip file; save the table as CSV");
  expect(2, first_lines(csv(), 21), "", "needs 25 or more");
  expect(2, first_lines(csv(), 500) + "100,N/A,0.1,0.1,0.1,0.1,0.1\n", "", "'N/A' is not a number");
  expect(2, "t,u,n,udot\n01.05.2023 12:00,1,2,3\n01.05.2023 12:01,2,3,4\n", "",
         "may have the day or the month first");
  write("model.json", "no model");
  write("log.csv", csv());
  expect_of(2, "predict log.csv --model model.json",
            "another file was given, or this one is damaged");
}

TEST_F(Mistakes, Words) {
  expect(2, csv(), "--set gama=1", "gama: unknown setting (did you mean 'gamma'?)");
  expect(2, csv(), "--split peaces", "did you mean 'pieces'?");
  expect_of(2, "lern log.csv", "There is no command 'lern' (did you mean 'learn'?)");
  expect_of(2, "learn log.csv --unit r=deg/s",
            "There is no option --unit (did you mean '--units'?)");
}

TEST_F(Mistakes, CommandsThatMoveNothing) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  write("log.csv", csv([&](Row& row) {
          row.n = normal(random);
          row.m = normal(random);
        }));
  expect_of(0, "learn log.csv --set preset=paper --set buffer=50 --out out",
            "WARNING: these commands do not move this vehicle");
  // No model to go on with: a look at the log comes next.
  const Outcome outcome = run("learn log.csv --set preset=paper --set buffer=50 --out out");
  EXPECT_NE(outcome.out.find("kelpie inspect log.csv"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("kelpie rollout"), std::string::npos) << outcome.out;
}

}  // namespace
}  // namespace kelpie::mistakes_test
