// SPDX-License-Identifier: Apache-2.0
#include "kelpie/data/dataset.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "kelpie/core/error.hpp"
#include "kelpie/data/csv.hpp"
#include "support.hpp"

namespace kelpie {
namespace {

using testing::message_of;

Table parse(const std::string& text) {
  std::istringstream stream(text);
  return read_csv(stream, "log.csv");
}

const std::string kLog = "t,u,v,udot\n0,1,5,0.1\n1,2,6,0.2\n3,3,5,0.3\n4,4,7,0.1\n";

Roles roles() {
  return {
      .inputs = {"u", "v"}, .targets = {"udot"}, .time = "t", .rate_hz = 0.0, .configuration = ""};
}

std::string refusal(const std::string& text, const Roles& wanted) {
  return message_of<InputError>([&] { make_dataset(parse(text), wanted); });
}

TEST(Dataset, TakesColumnsByNameInTheOrderAsked) {
  Roles wanted = roles();
  wanted.inputs = {"v", "u"};
  const Dataset data = make_dataset(parse(kLog), wanted);
  ASSERT_EQ(data.rows(), 4U);
  EXPECT_EQ(data.input(1)[0], 6.0);
  EXPECT_EQ(data.input(1)[1], 2.0);
  EXPECT_EQ(data.target(2)[0], 0.3);
  EXPECT_EQ(data.times_s, (std::vector<double>{0.0, 1.0, 3.0, 4.0}));
  EXPECT_EQ(data.rate_hz, 1.0);
}

TEST(Dataset, RowsWithoutNumbersAreSkippedAndCounted) {
  const Dataset data =
      make_dataset(parse("t,u,v,udot,w\n0,1,5,0.1,nan\n1,nan,6,0.2,1\n2,3,inf,0.3,1\n3,4,7,0.2,1\n"
                         "4,5,8,,1\n"),
                   roles());
  EXPECT_EQ(data.rows_read, 5U);
  EXPECT_EQ(data.rows_skipped, 3U);
  EXPECT_EQ(data.times_s, (std::vector<double>{0.0, 3.0}));
}

// A skipped row takes its time: later rows stay where they were.
TEST(Dataset, ARateCountsSkippedRows) {
  Roles wanted = roles();
  wanted.time = "";
  wanted.rate_hz = 4.0;
  const Dataset data = make_dataset(parse("u,v,udot\n1,5,0.1\nnan,6,0.2\n3,7,0.3\n"), wanted);
  EXPECT_EQ(data.times_s, (std::vector<double>{0.0, 0.5}));
  EXPECT_EQ(data.rate_hz, 4.0);
}

TEST(Dataset, RefusalsNameFileLineAndColumn) {
  Roles wanted = roles();
  wanted.inputs = {"u", "w"};
  EXPECT_EQ(
      refusal(kLog, wanted),
      "log.csv: w: there is no such column (did you mean 't'?); the columns are t, u, v, udot");
  wanted.inputs = {"u", "udot"};
  EXPECT_EQ(refusal(kLog, wanted), "log.csv: udot: is named twice among the inputs and targets");
  EXPECT_EQ(refusal("t,u,v,udot\n0,1,5,0.1\n2,2,6,0.2\n1,3,5,0.3\n", roles()),
            "log.csv:4: t: time runs backwards, from 2 to 1 s");
  EXPECT_EQ(refusal("t,u,v,udot\n0,1,5,0.1\n1,x,6,0.2\n", roles()),
            "log.csv:3: u: 'x' is not a number");
  EXPECT_EQ(refusal("t,u,v,udot\n0,1,5,0.1\n1,2,5,0.2\n", roles()),
            "log.csv: v: is constant (5) so that the covariance Σ is singular; leave it out of the "
            "inputs");
  EXPECT_NE(refusal("t,u,v,udot\n0,1,5,1\n1,2,6,1\n", roles()).find("nothing to learn"),
            std::string::npos);
  EXPECT_NE(refusal("t,u,v,udot\n0,1,5,nan\n1,2,6,1\n", roles()).find("fewer than two rows"),
            std::string::npos);
}

TEST(Dataset, WantsATimeOrARateAndNotBoth) {
  Roles wanted = roles();
  wanted.time = "";
  EXPECT_NE(refusal(kLog, wanted).find("--rate"), std::string::npos);
  wanted.rate_hz = -1.0;
  EXPECT_EQ(refusal(kLog, wanted),
            "log.csv: rate: -1 is out of range; it has to be > 0 rows per second");
  wanted.rate_hz = 1.0;
  wanted.time = "t";
  EXPECT_NE(refusal(kLog, wanted).find("given twice"), std::string::npos);
}

TEST(Dataset, ConfigurationsAreWholeNumbers) {
  Roles wanted = roles();
  wanted.configuration = "v";
  wanted.inputs = {"u"};
  EXPECT_EQ(make_dataset(parse(kLog), wanted).configurations, (std::vector<int>{5, 6, 5, 7}));
  EXPECT_EQ(refusal("t,u,v,udot\n0,1,5,0.1\n1,2,1e300,0.2\n", wanted),
            "log.csv:3: v: 1e+300 doesn't number a configuration; whole numbers do");
}

TEST(GuessRoles, KnowsTheNamesPeopleUse) {
  const Roles real =
      guess_roles(parse("u,v,r,th1,th2,th3,udot,vdot,rdot\n1,2,3,4,5,6,7,8,9\n"), {});
  EXPECT_EQ(real.inputs, (std::vector<std::string>{"u", "v", "r", "th1", "th2", "th3"}));
  EXPECT_EQ(real.targets, (std::vector<std::string>{"udot", "vdot", "rdot"}));
  EXPECT_EQ(real.time, "");
  const Roles hover = guess_roles(parse("t,u,m1,du,mode\n1,2,3,4,x\n"), {});
  EXPECT_EQ(hover.inputs, (std::vector<std::string>{"u", "m1"}));
  EXPECT_EQ(hover.targets, (std::vector<std::string>{"du"}));
  EXPECT_EQ(hover.time, "t");
  const Roles peers = guess_roles(parse("conf,split,u,n1,du\n1,2,3,4,5\n"), {});
  EXPECT_EQ(peers.configuration, "conf");
  EXPECT_EQ(peers.inputs, (std::vector<std::string>{"u", "n1"}));
}

TEST(GuessRoles, KeepsWhatIsGiven) {
  const Roles given{
      .inputs = {"v"}, .targets = {"u"}, .time = "", .rate_hz = 2.0, .configuration = ""};
  const Roles roles = guess_roles(parse(kLog), given);
  EXPECT_EQ(roles.inputs, given.inputs);
  EXPECT_EQ(roles.targets, given.targets);
  EXPECT_EQ(roles.time, "");
  EXPECT_NE(message_of<InputError>([] { guess_roles(parse("a,b\n1,2\n"), {}); }).find("--targets"),
            std::string::npos);
}

}  // namespace
}  // namespace kelpie
