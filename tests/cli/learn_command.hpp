// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "cli/command.hpp"
#include "support.hpp"

namespace kelpie::testing {

/// `kelpie learn` in a folder of its own, with a log.
class Learn : public ::testing::Test {
 protected:
  void SetUp() override { write_text(folder_ / "log.csv", little_log(2400)); }

  /// The command has to refuse with exit code 2, say why, and write nothing.
  void expect_refused(const std::string& arguments, const std::string& message) {
    const Outcome outcome = kelpie(folder_.path(), "learn " + arguments + " --out refused");
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << arguments << "\n" << outcome.err;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "refused")) << arguments;
  }

  TemporaryFolder folder_;
};

}  // namespace kelpie::testing
