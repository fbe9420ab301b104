// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "cli/command.hpp"
#include "support.hpp"

namespace kelpie::testing {

/// `kelpie learn` in a folder of its own, with a log.
class Learn : public CommandTest {
 protected:
  void SetUp() override { write("log.csv", little_log(2400)); }

  /// The command has to refuse with exit code 2, say why, and write nothing.
  void expect_refused(const std::string& arguments, const std::string& message) {
    const Outcome outcome = run("learn " + arguments + " --out refused");
    testing::expect_refused(outcome, message);
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_FALSE(exists("refused")) << arguments;
  }
};

}  // namespace kelpie::testing
