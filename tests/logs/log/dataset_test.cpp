// SPDX-License-Identifier: Apache-2.0
#include "log/dataset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::dataset_test {
namespace {

using testing::data_file;
using testing::message_of;
using Names = std::vector<std::string>;
using Numbers = std::vector<double>;

const log::Roles kTimed{
    .inputs = {"u", "n"}, .targets = {"a"}, .time = "t", .rate_hz = 0.0, .configuration = ""};

log::Table parse(const std::string& text) {
  return log::parse_csv(text, "log.csv");
}

log::Roles with_rate(double rate_hz) {
  log::Roles roles = kTimed;
  roles.time.clear();
  roles.rate_hz = rate_hz;
  return roles;
}

std::string refusal(const std::string& text, const log::Roles& roles = kTimed) {
  return message_of<InputError>([&] { log::make_dataset(parse(text), roles); });
}

void expect_start(const std::string& message, const std::string& start) {
  EXPECT_TRUE(message.starts_with(start)) << "is: " << message << "\nnot: " << start;
}

TEST(Dataset, TakesColumnsByNameRowByRow) {
  const log::Dataset data = log::make_dataset(parse("a,x,n,u,t\n1,0,2,3,0\n4,0,5,6,0.5\n"), kTimed);
  EXPECT_EQ(data.input_names, (Names{"u", "n"}));
  EXPECT_EQ(data.target_names, Names{"a"});
  EXPECT_EQ(data.inputs, (Numbers{3, 2, 6, 5}));
  EXPECT_EQ(data.targets, (Numbers{1, 4}));
  EXPECT_EQ(data.input(1)[0], 6.0);
  EXPECT_EQ(data.target(1)[0], 4.0);
  EXPECT_EQ(data.times_s, (Numbers{0, 0.5}));
  EXPECT_EQ(data.configurations, (std::vector<int>{0, 0}));
  EXPECT_EQ(data.rate_hz, 2.0);
}

TEST(Dataset, SkipsAndCountsRowsThatAreNotFinite) {
  const log::Table table =
      parse("u,n,a,mode,other\n1,2,3,x,\n,1,1,x,\n1,inf,1,x,\n4,5,nan,,\n7,8,9,,\n");
  const log::Dataset data = log::make_dataset(table, with_rate(10.0));
  EXPECT_EQ(data.rows_read, 5U);
  EXPECT_EQ(data.rows_skipped, 3U);
  EXPECT_EQ(data.inputs, (Numbers{1, 2, 7, 8}));
  EXPECT_EQ(data.times_s, (Numbers{0.0, 0.4}));  // a gap stays a gap
  EXPECT_EQ(data.rate_hz, 10.0);
}

TEST(Dataset, RateIsThatOfTheMedianStep) {
  const auto rate = [](const std::string& stamps) {
    std::string text = "u,n,a,t\n";
    int row = 0;
    std::istringstream stream(stamps);
    for (std::string stamp; stream >> stamp; ++row) {
      const std::string number = std::to_string(row);
      text += number + "," + number + "," + number + "," + stamp + "\n";
    }
    return log::make_dataset(parse(text), kTimed).rate_hz;
  };
  EXPECT_DOUBLE_EQ(rate("0 0.25 0.5 100 100.25"), 4.0);
  EXPECT_DOUBLE_EQ(rate("0 1 4"), 0.5);            // an even number of steps
  EXPECT_DOUBLE_EQ(rate("0 0 0 0.5 0.5 1"), 2.0);  // equal stamps apart
}

TEST(Dataset, NumbersConfigurations) {
  log::Roles roles = kTimed;
  roles.configuration = "conf";
  const log::Dataset data =
      log::make_dataset(parse("u,n,a,t,conf\n1,2,3,0,1\n4,5,6,1,2\n7,8,9,2,1\n"), roles);
  EXPECT_EQ(data.configurations, (std::vector<int>{1, 2, 1}));
  expect_start(refusal("u,n,a,t,conf\n1,2,3,0,1\n4,5,6,1,1.5\n", roles),
               "log.csv:3: conf: 1.5 can't number a configuration");
  expect_start(refusal("u,n,a,t,conf\n1,2,3,0,1e10\n4,5,6,1,1\n", roles), "log.csv:2: conf: ");
}

TEST(Dataset, KnowsTheRowsThatAColumnMarksAsHeldOut) {
  log::Roles roles = kTimed;
  EXPECT_TRUE(
      log::make_dataset(parse("u,n,a,t,held\n1,2,3,0,1\n4,5,6,1,0\n"), roles).held_out.empty());
  roles.held_out = "held";
  const log::Dataset data =
      log::make_dataset(parse("u,n,a,t,held\n1,2,3,0,1\n,5,6,1,1\n4,5,6,2,0\n"), roles);
  EXPECT_EQ(data.held_out, (std::vector<bool>{true, false}));  // without the row that is skipped
  expect_start(refusal("u,n,a,t,held\n1,2,3,0,1\n4,5,6,1,0.5\n", roles),
               "log.csv:3: held: 0.5 doesn't say whether the row is held out; 1 (held out) or 0");
}

TEST(Dataset, WordsInAColumnInUseAreNamedWithTheirPlace) {
  expect_start(refusal("u,n,a,t\n1,2,3,0\n1,off,3,1\n"), "log.csv:3: n: 'off' is not a number");
  expect_start(refusal("u,n,a,t\n\"1,5\",2,3,0\n"),
               "log.csv:2: u: '1,5' is not a number; decimals take a point, as in 1.5");
  expect_start(refusal("u,n,a,t\n1,2,1e400,0\n"),
               "log.csv:2: a: '1e400' is not a number (or out of a double's range)");
}

TEST(Dataset, TimeMayStandButNotRunBackwards) {
  EXPECT_NO_THROW(log::make_dataset(parse("u,n,a,t\n1,2,3,0\n4,5,6,1\n7,8,9,1\n"), kTimed));
  // Row 3 is skipped for its u, its stamp counts.
  expect_start(refusal("u,n,a,t\n1,2,3,0\n,2,3,3.5\n4,5,6,\n7,8,9,3.4\n"),
               "log.csv:5: t: time runs backwards, from 3.5 (line 3) to 3.4 s");
  expect_start(refusal("u,n,a,t\n1,2,3,5\n4,5,6,5\n"), "log.csv: t: time stands still");
}

TEST(Dataset, ConstantColumnsAreNamedWithTheirValue) {
  EXPECT_NO_THROW(log::make_dataset(parse("u,n,a,t\n1,2,3,0\n4,2,6,1\n"), kTimed))
      << "a model may want a command that rests in this log";
  expect_start(refusal("u,n,a,t\n1,2,3,0\n4,5,3,1\n"),
               "log.csv: a: is 3 in every row: nothing to learn");
  // What varies only in rows that are skipped is constant.
  expect_start(refusal("u,n,a,t\n1,2,3,0\n4,2,3,1\n,9,4,2\n"), "log.csv: a: is 3 in every row");
}

TEST(Dataset, TooFewRowsAreCounted) {
  expect_start(refusal("u,n,a,t\n1,2,3,0\n1,,3,0\n"),
               "log.csv: 1 of 2 rows have a finite number in every column in use; 2 or more");
  expect_start(refusal("u,n,a,t\n1,,3,0\n4,inf,3,0\n"), "log.csv: n: holds no finite number");
}

TEST(Dataset, RolesHaveToMakeSense) {
  const std::string log = "u,n,a,t\n1,2,3,0\n4,5,6,1\n";
  log::Roles roles = kTimed;
  roles.inputs = {"u", "thrust"};
  expect_start(refusal(log, roles), "log.csv: thrust: there is no such column");
  roles.inputs = {"u", "u"};
  expect_start(refusal(log, roles), "log.csv: u: is named twice");
  roles.inputs = {"u", "a"};
  expect_start(refusal(log, roles), "log.csv: a: is named twice");
  roles.inputs = {};
  expect_start(refusal(log, roles), "log.csv: inputs: ");
  roles = kTimed;
  roles.targets = {};
  expect_start(refusal(log, roles), "log.csv: targets: ");
  roles = kTimed;
  roles.rate_hz = 4.0;
  expect_start(refusal(log, roles), "log.csv: time: both");
  expect_start(refusal(log, with_rate(0.0)), "log.csv: time: is unknown");
  for (const double rate : {-1.0, HUGE_VAL, std::numeric_limits<double>::quiet_NaN()}) {
    expect_start(refusal(log, with_rate(rate)), "log.csv: rate: ");
  }
}

TEST(Dataset, UnitsAreThoseOfColumns) {
  const std::string log = "u,n,a,t\n1,2,3,0\n4,5,6,1\n";
  log::Roles roles = kTimed;
  roles.units = {{"u", "m/s"}, {"a", "m/s^2"}};
  const log::Dataset data = log::make_dataset(parse(log), roles);
  ASSERT_EQ(data.units.size(), 2U);
  EXPECT_EQ(data.units.at("a").text(), "m s^-2");
  roles.units = {{"a", "m/s2"}};
  expect_start(refusal(log, roles), "log.csv: a: 'm/s2' is not a unit such as m/s^2: ");
  roles.units = {{"w", "m/s"}};
  expect_start(refusal(log, roles), "log.csv: w: there is no such column");
}

TEST(Dataset, AMissingColumnIsGuessed) {
  log::Roles roles = kTimed;
  roles.inputs = {"thr1"};
  const std::string message = refusal("thr_1,a,t\n1,2,0\n3,4,1\n", roles);
  EXPECT_NE(message.find("did you mean 'thr_1'"), std::string::npos) << message;
  EXPECT_NE(message.find("the columns are thr_1, a, t"), std::string::npos) << message;
}

TEST(Dataset, TakesTheRealLog) {
  const auto file = data_file("dagon_config1.csv");
  if (file.empty()) {
    GTEST_SKIP() << "dagon_config1.csv is absent; set KELPIE_DATA_DIR to its folder";
  }
  log::Roles given;
  given.rate_hz = 4.0;
  const log::Table table = log::read_csv(file);
  const log::Dataset data = log::make_dataset(table, log::guess_roles(table, given));
  EXPECT_EQ(data.rows(), 11567U);
  EXPECT_EQ(data.rows_skipped, 0U);
  EXPECT_EQ(data.input_names.size(), 6U);
  EXPECT_EQ(data.target(0)[0], -0.0234383224719);
  EXPECT_EQ(data.times_s[1], 0.25);
}

}  // namespace
}  // namespace kelpie::dataset_test
