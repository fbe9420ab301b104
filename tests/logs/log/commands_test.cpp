// SPDX-License-Identifier: Apache-2.0
#include "log/dataset.hpp"

#include <gtest/gtest.h>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::commands_test {
namespace {

using testing::message_of;

log::Table table(const std::string& text) {
  return log::parse_csv(text, "c.csv");
}

std::string refusal(const std::string& text, const log::Roles& roles) {
  return message_of<InputError>([&] { log::make_commands(table(text), roles, {{"u", 0.5}}); });
}

TEST(Commands, TakesConstantsAndConstantColumns) {
  const log::Dataset data =
      log::make_commands(table("t,n\n0,3\n0.5,3\n2,4\n"), {.inputs = {"u", "n"}}, {{"u", 0.5}});
  EXPECT_EQ(data.inputs, (std::vector<double>{0.5, 3, 0.5, 3, 0.5, 4}));
  EXPECT_EQ(data.times_s, (std::vector<double>{0.0, 0.5, 2.0}));
  const log::Dataset rated =
      log::make_commands(table("n\n3\n4\n"), {.inputs = {"n"}, .rate_hz = 4.0}, {});
  EXPECT_EQ(rated.times_s, (std::vector<double>{0.0, 0.25}));
}

TEST(Commands, TimesAreInTheUnitOfTheirColumn) {
  const std::vector<double> seconds{0.0, 0.1, 0.3};
  EXPECT_EQ(
      log::make_commands(table("t [ms],n\n0,3\n100,3\n300,4\n"), {.inputs = {"n"}}, {}).times_s,
      seconds);
  log::Table told = table("t,n\n0,3\n100,3\n300,4\n");
  log::convert_units(told, {{"t", "ms"}});
  EXPECT_EQ(log::make_commands(told, {.inputs = {"n"}}, {}).times_s, seconds);
  EXPECT_NE(refusal("t [m],n\n0,3\n1,3\n", {.inputs = {"u", "n"}}).find("not a unit of time"),
            std::string::npos);
}

TEST(Commands, RefusesWhatCantBeFollowedNamingTheLine) {
  const log::Roles roles{.inputs = {"u", "n"}};
  EXPECT_EQ(refusal("t,n\n0,3\n1,\n", roles), "c.csv:3: n: nan where a finite number is needed");
  EXPECT_EQ(refusal("t,n\n0,3\n0,3\n", roles), "c.csv:3: t: 0 s after 0 s; time has to increase");
  EXPECT_EQ(refusal("t,n\n0,3\n", roles), "c.csv: rows: 1; at least two are needed");
  EXPECT_NE(refusal("n,m\n0,3\n0,3\n", roles).find("--rate"), std::string::npos);
  EXPECT_NE(refusal("t,m\n0,3\n1,3\n", roles).find("n: there is no such column"),
            std::string::npos);
}

}  // namespace
}  // namespace kelpie::commands_test
