// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "cli/command.hpp"
#include "support.hpp"

namespace kelpie::output_test {
namespace {

using testing::kelpie;
using testing::Outcome;
using testing::TemporaryFolder;
using testing::write_text;

TEST(Output, AColumnsNameCannotSteerATerminal) {
  const TemporaryFolder folder;
  write_text(folder / "log.csv", "t,u,\x1b[31mu,udot\n0,1,x,2\n1,2,y,3\n");
  const Outcome outcome = kelpie(folder.path(), "learn log.csv --inputs m --out out");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("\uFFFD[31mu"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find('\x1b'), std::string::npos);
}

TEST(Output, ASlipOfTheFingerIsToldWhatWasMeant) {
  const TemporaryFolder folder;
  const auto said = [&](const std::string& arguments) {
    const Outcome outcome = kelpie(folder.path(), arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_NE(outcome.err.find("Run with --help"), std::string::npos) << outcome.err;
    return outcome.err.substr(0, outcome.err.find('\n'));
  };
  EXPECT_EQ(
      said("lern log.csv").find("There is no command 'lern' (did you mean 'learn'?); there are"),
      0U);
  EXPECT_EQ(said("surface log.csv").find("There is no command 'surface'; there are learn, live"),
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
  EXPECT_EQ(said(""), "A subcommand is required");
}

}  // namespace
}  // namespace kelpie::output_test
