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

}  // namespace
}  // namespace kelpie::output_test
