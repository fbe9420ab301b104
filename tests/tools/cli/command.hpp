// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "kelpie/core/random.hpp"
#include "support.hpp"

namespace kelpie::testing {

/// How a command ended and what it said.
struct Outcome {
  int exit_code = -1;
  std::string out;
  std::string err;
};

inline std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Runs the built kelpie with `arguments` in `folder`, without a terminal.
inline Outcome kelpie(const std::filesystem::path& folder, const std::string& arguments) {
  const std::string command = "cd '" + folder.string() + "' && " KELPIE_COMMAND " " + arguments +
                              " >.stdout 2>.stderr </dev/null";
  const int status = std::system(command.c_str());  // NOLINT: the arguments are the tests' own
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content_of(folder / ".stdout"),
          content_of(folder / ".stderr")};
}

/// The command has to end with exit code 0.
inline Outcome succeeded(const Outcome& outcome) {
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return outcome;
}

/// The command has to end with exit code 2 and a message that contains `message`.
inline void expect_refused(const Outcome& outcome, const std::string& message) {
  EXPECT_EQ(outcome.exit_code, 2) << message << "\n" << outcome.out;
  EXPECT_NE(outcome.err.find(message), std::string::npos) << message << "\n" << outcome.err;
}

/// Settings for tests of what holds with few samples as with many: a fifth of the computing.
inline const std::string kFewSamples = " --set buffer=60 --set anchors=20";

/// Commands in a folder of their own; the names of files are relative to the folder.
class CommandTest : public ::testing::Test {
 protected:
  Outcome run(const std::string& arguments) const { return kelpie(folder_.path(), arguments); }

  /// A command with `--out refused` has to be refused, and to write nothing.
  void expect_nothing_written(const std::string& command, const std::string& message) const {
    expect_refused(run(command + " --out refused"), message);
    EXPECT_FALSE(exists("refused")) << command;
  }

  std::string content(const std::string& file) const { return content_of(folder_ / file); }
  nlohmann::json parsed(const std::string& file) const {
    return nlohmann::json::parse(content(file));
  }
  void write(const std::string& file, const std::string& text) const {
    write_text(folder_ / file, text);
  }
  bool exists(const std::string& file) const { return std::filesystem::exists(folder_ / file); }

  TemporaryFolder folder_;
};

/// A log of a little vehicle that moves along one axis: u, n → udot, 10 Hz.
inline std::string little_log(std::size_t rows) {
  RandomStream random(1, "log");
  std::string text = "t,u,n,udot\n";
  double u = 0.0;
  double phase = 0.0;
  for (std::size_t i = 0; i < rows; ++i) {
    phase += random.uniform(0.01, 0.05);
    const double n = 10.0 * std::sin(phase);
    const double acceleration = 0.01 * n * std::abs(n) - 2.0 * u * std::abs(u) - 0.3 * u;
    text += std::to_string(0.1 * static_cast<double>(i)) + "," + std::to_string(u) + "," +
            std::to_string(n) + "," + std::to_string(acceleration) + "\n";
    u += 0.1 * acceleration;
  }
  return text;
}

}  // namespace kelpie::testing
