// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "log/dataset.hpp"
#include "support.hpp"

namespace kelpie::roles_test {
namespace {

using testing::message_of;
using Names = std::vector<std::string>;

log::Table with_columns(const std::string& names) {
  log::Table table;
  table.source = "log.csv";
  table.names = split_text(names, ',');
  return table;
}

log::Roles guess(const std::string& names, const log::Roles& given = {}) {
  return log::guess_roles(with_columns(names), given);
}

TEST(Roles, ALetterBesideTheDottedAccelerationIsARudder) {
  const log::Roles roles = guess("t,u,v,r,dr,ds,n,udot,vdot,rdot");
  EXPECT_EQ(roles.targets, (Names{"udot", "vdot", "rdot"}));
  EXPECT_EQ(roles.inputs, (Names{"u", "v", "r", "dr", "ds", "n"}));
}

TEST(Roles, GuessesThePartsOfARealLog) {
  const log::Roles roles = guess("u,v,r,th1,th2,th3,udot,vdot,rdot");
  EXPECT_EQ(roles.inputs, (Names{"u", "v", "r", "th1", "th2", "th3"}));
  EXPECT_EQ(roles.targets, (Names{"udot", "vdot", "rdot"}));
  EXPECT_EQ(roles.time, "");
  EXPECT_EQ(roles.configuration, "");
}

TEST(Roles, GuessesThePartsOfATimedLog) {
  const log::Roles roles = guess("t,u,v,r,m1,m2,m3,m4,m5,m6,du,dv,dr");
  EXPECT_EQ(roles.inputs, (Names{"u", "v", "r", "m1", "m2", "m3", "m4", "m5", "m6"}));
  EXPECT_EQ(roles.targets, (Names{"du", "dv", "dr"}));
  EXPECT_EQ(roles.time, "t");
}

TEST(Roles, ConfigurationAndSplitAreNoInputs) {
  const log::Roles roles = guess("conf,split,u,v,r,n1,n2,n3,du,dv,dr");
  EXPECT_EQ(roles.inputs, (Names{"u", "v", "r", "n1", "n2", "n3"}));
  EXPECT_EQ(roles.targets, (Names{"du", "dv", "dr"}));
  EXPECT_EQ(roles.configuration, "conf");
}

TEST(Roles, TheTruthOfASimulationIsNoInput) {
  EXPECT_EQ(guess("time,u,n1,udot,udot_true").inputs, (Names{"u", "n1"}));
  EXPECT_EQ(guess("time,u,is_true,udot").inputs, (Names{"u", "is_true"}));
}

TEST(Roles, AnAccelerationIsNamedAfterAColumnOfTheSameCase) {
  const log::Roles roles = guess("stamp,U,Udot,surge,surge_dot,dot,d,duration,dt,dx");
  EXPECT_EQ(roles.targets, (Names{"Udot", "surge_dot"}));
  EXPECT_EQ(roles.inputs, (Names{"U", "surge", "dot", "d", "duration", "dt", "dx"}));
  EXPECT_EQ(guess("t,u,dt,du").targets, Names{"du"});
  EXPECT_THROW(guess("u,Udot"), InputError);
}

TEST(Roles, ADerivativeIsNoInputWhereTheUnitOfItsColumnIsUnknown) {
  const log::Roles roles = guess("t,u [furlongs],v (fl),n,udot,vdot (fl/t)");
  EXPECT_EQ(roles.targets, (Names{"udot", "vdot (fl/t)"}));
  EXPECT_EQ(roles.inputs, (Names{"u [furlongs]", "v (fl)", "n"}));
  EXPECT_EQ(guess("t,u [furlongs],w,n,udot,wdot", {.targets = {"wdot"}}).inputs,
            (Names{"w", "u [furlongs]", "n"}));
  EXPECT_EQ(guess("t,n[0],n[1],ndot,u,udot").inputs, (Names{"u", "n[0]", "n[1]", "ndot"}));
}

TEST(Roles, WhatSensorsMeasureIsNoCommand) {
  const std::string measured =
      "ax,ay,az,accx,acc_y,AccelZ,imu_1,temp,temp_c,temperature2,water_temperature,sog,cog,n_sats,"
      "sats,power_w,lat,longitude";
  const std::string commands = "a1,az1,accumulator,acc,power,motor_power,n1,n_port,template";
  EXPECT_EQ(guess("t,u," + measured + "," + commands + ",udot").inputs,
            split_text("u," + commands, ','));
  const log::Table table = with_columns("t,u,ax,n,udot");
  EXPECT_EQ(log::left_out_text(table, {}),
            "log.csv: ax: is left out of the inputs: an acceleration; --inputs takes it\n");
  EXPECT_EQ(log::guess_roles(table, {.inputs = {"u", "ax"}}).inputs, (Names{"u", "ax"}));
  EXPECT_EQ(guess("t,imu_u,n,imu_udot").inputs, (Names{"imu_u", "n"})) << "a state";
}

TEST(Roles, WordsAreNeverInputs) {
  const std::string text = "mode,u,n1,udot\nhover,1,2,3\n";
  EXPECT_EQ(log::guess_roles(log::parse_csv(text, "log.csv"), {}).inputs, (Names{"u", "n1"}));
}

TEST(Roles, AFewWordsAmongNumbersAreAFaultAndNoReasonToLeaveAColumnOut) {
  const std::string text = "t,u,n,udot\n0,1,2,3\n1,2,N/A,4\n2,3,4,6\n";
  const log::Table table = log::parse_csv(text, "log.csv");
  const log::Roles roles = log::guess_roles(table, {});
  EXPECT_EQ(roles.inputs, (Names{"u", "n"}));
  EXPECT_EQ(message_of<InputError>([&] { log::make_dataset(table, roles); }).substr(0, 39),
            "log.csv:3: n: 'N/A' is not a number (or");
  EXPECT_EQ(log::left_out_text(table, {}), "");
}

TEST(Roles, WhatIsLeftOutForItsWordsIsTold) {
  const std::string text = "t,note,u,n,udot\n0,,1,2,3\n1,dive 7,2,3,4\n";
  const log::Table table = log::parse_csv(text, "log.csv");
  EXPECT_EQ(log::left_out_text(table, {}),
            "log.csv:3: note: is left out of the inputs: 'dive 7' is not a number\n");
  log::Roles given;
  given.inputs = {"u"};
  EXPECT_EQ(log::left_out_text(table, given), "") << "the user's own choice";
}

log::Table rows_of(const std::string& header, const std::vector<std::string>& rows) {
  std::string text = header + "\n";
  for (const std::string& row : rows) {
    text += row + "\n";
  }
  return log::parse_csv(text, "log.csv");
}

TEST(Roles, AColumnThatTellsNothingIsLeftOutWithTheReason) {
  const log::Table table =
      rows_of("t,run,row,depth,u,w,n,copy,rps,udot,wdot",
              {"0,4,1,7,1,0,2,2,9,3,0", "1,4,2,8,2,0,5,5,9,1,0", "2,5,3,9,1,0,3,3,9,2,0"});
  const log::Roles roles = log::guess_roles(table, {});
  EXPECT_EQ(roles.inputs, (Names{"u", "n"}));
  EXPECT_EQ(roles.targets, (Names{"udot"})) << "a constant target has nothing to learn";
  EXPECT_EQ(log::left_out_text(table, {}),
            "log.csv: wdot: is left out of the targets: 0 in every row\n"
            "log.csv: run: is left out of the inputs: a counter\n"
            "log.csv: row: is left out of the inputs: a counter\n"
            "log.csv: depth: is left out of the inputs: a position\n"
            "log.csv: w: is left out of the inputs: 0 in every row\n"
            "log.csv: copy: is left out of the inputs: equals n in every row\n"
            "log.csv: rps: is left out of the inputs: 9 in every row\n");
}

TEST(Roles, HeadingsBatteriesAndWhatIsIgnoredAreLeftOut) {
  const log::Table table = rows_of("t,u,psi,battery_V,soc,th1,n,udot,ndot",
                                   {"0,1,7,3,1,1,2,3,1", "1,2,8,1,2,4,3,1,4", "2,1,9,2,4,2,7,2,3"});
  log::Roles given;
  given.ignored = {"th1", "ndot"};
  const log::Roles roles = log::guess_roles(table, given);
  EXPECT_EQ(roles.inputs, (Names{"u", "n"}));
  EXPECT_EQ(roles.targets, (Names{"udot"}));
  EXPECT_EQ(log::left_out_text(table, given),
            "log.csv: psi: is left out of the inputs: a heading\n"
            "log.csv: battery_V: is left out of the inputs: of a battery\n"
            "log.csv: soc: is left out of the inputs: of a battery\n"
            "log.csv: th1: is left out of the inputs: ignored, as asked\n");
  given.ignored = {"thr1"};
  EXPECT_NE(message_of<InputError>([&] {
              log::guess_roles(table, given);
            }).find("thr1: there is no such column (did you mean 'th1'?)"),
            std::string::npos);
  given.ignored = {"u"};
  given.inputs = {"u"};
  EXPECT_THROW(log::guess_roles(table, given), InputError);
}

TEST(Roles, AConstantThatIsNamedAnInputIsLeftOutAloud) {
  const log::Table table = rows_of("t,u,n,udot", {"0,1,7,3", "1,2,7,1", "2,1,7,2"});
  log::Roles given;
  given.inputs = {"u", "n"};
  EXPECT_EQ(log::without_constants(table, given).inputs, (Names{"u"}));
  EXPECT_EQ(log::left_out_text(table, given),
            "log.csv: n: is left out of the inputs: 7 in every row\n");
  given.inputs = {"n"};
  EXPECT_EQ(log::without_constants(table, given).inputs, (Names{"n"})) << "else there is none";
}

TEST(Roles, WhatIsAskedForIsAnInput) {
  const log::Table table = rows_of("t,u,depth,udot", {"0,1,7,3", "1,2,8,1", "2,1,9,2"});
  log::Roles given;
  given.inputs = {"u", "depth"};
  EXPECT_EQ(log::guess_roles(table, given).inputs, (Names{"u", "depth"}));
  EXPECT_EQ(log::left_out_text(table, given), "");
}

TEST(Roles, VelocitiesStandFirstWhereverTheyAre) {
  const log::Table table = rows_of("th1,th2,r,u,udot,rdot", {"1,4,2,7,5,1", "2,3,1,9,6,2"});
  EXPECT_EQ(log::guess_roles(table, {.rate_hz = 4.0}).inputs, (Names{"r", "u", "th1", "th2"}));
}

// Guessing and refusing such a header took minutes.
TEST(Roles, AMillionColumnsAreTooMany) {
  log::Table table;
  table.source = "log.csv";
  table.names = {"t", "u", "udot"};
  for (int i = 0; i < 1'000'000; ++i) {
    table.names.push_back("n" + std::to_string(i));
  }
  table.columns.resize(table.names.size());
  const std::string message = message_of<InputError>([&] { log::guess_roles(table, {}); });
  EXPECT_NE(message.find("more than 64 columns are left"), std::string::npos);
  EXPECT_NE(message.find("and 999803 more"), std::string::npos);
  EXPECT_LT(message.size(), 3000U);
}

TEST(Roles, WhatIsGivenStays) {
  log::Roles given;
  given.targets = {"udot"};
  given.rate_hz = 4.0;
  given.configuration = "tank";
  const log::Roles roles = guess("t,tank,u,v,udot,vdot", given);
  EXPECT_EQ(roles.targets, Names{"udot"});
  EXPECT_EQ(roles.inputs, (Names{"u", "v"}));  // vdot would give udot away
  EXPECT_EQ(roles.time, "");                   // a rate is there
  EXPECT_EQ(roles.configuration, "tank");

  log::Roles inputs;
  inputs.inputs = {"u", "vdot"};
  EXPECT_EQ(guess("u,v,udot,vdot", inputs).targets, Names{"udot"});
}

TEST(Roles, SaysWhichColumnsThereAreWhenNothingFits) {
  const std::string message = message_of<InputError>([] { guess("surge,thrust"); });
  EXPECT_TRUE(message.starts_with("log.csv: targets: ")) << message;
  EXPECT_NE(message.find("--targets"), std::string::npos) << message;
  EXPECT_NE(message.find("surge, thrust"), std::string::npos) << message;

  log::Roles all_taken;
  all_taken.targets = {"u"};
  EXPECT_THROW(guess("t,u", all_taken), InputError);
}

}  // namespace
}  // namespace kelpie::roles_test
