// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "cli/command.hpp"

namespace kelpie::output_test {
namespace {

using testing::kelpie;
using testing::Outcome;

using Output = testing::CommandTest;

TEST_F(Output, AColumnsNameCannotSteerATerminal) {
  write("log.csv", "t,u,\x1b[31mu,udot\n0,1,x,2\n1,2,y,3\n");
  const Outcome outcome = run("learn log.csv --inputs m --out out");
  testing::expect_refused(outcome, "\uFFFD[31mu");
  EXPECT_EQ(outcome.err.find('\x1b'), std::string::npos);
}

TEST_F(Output, ASlipOfTheFingerIsToldWhatWasMeant) {
  const auto said = [&](const std::string& arguments) {
    const Outcome outcome = run(arguments);
    testing::expect_refused(outcome, "Run with --help");
    return outcome.err.substr(0, outcome.err.find('\n'));
  };
  EXPECT_EQ(
      said("lern log.csv").find("There is no command 'lern' (did you mean 'learn'?); there are"),
      0U);
  EXPECT_EQ(said("surface log.csv").find("There is no command 'surface'; there are inspect, learn"),
            0U);
  EXPECT_EQ(said("learn log.csv --rat 4"), "There is no option --rat (did you mean '--rate'?)");
  EXPECT_EQ(said("learn log.csv --rat=4"), "There is no option --rat (did you mean '--rate'?)");
  EXPECT_EQ(said("predict log.csv --modle m.json"),
            "There is no option --modle (did you mean '--model'?)");
  EXPECT_EQ(said("memory lst").find("There is no command 'lst' (did you mean 'list'?); there are"),
            0U);
  EXPECT_EQ(said("learn log.csv --surface"), "There is no option --surface");
  EXPECT_EQ(said("predict log.csv more.csv --model m.json"),
            "The following argument was not expected: more.csv");
}

}  // namespace
}  // namespace kelpie::output_test
