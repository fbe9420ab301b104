// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/output.hpp"
#include "cli/program.hpp"
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

/// The words of a command line as a shell takes them: parted by spaces, joined by quotes.
inline std::vector<std::string> words_of(const std::string& arguments) {
  std::vector<std::string> words;
  char quote = ' ';
  bool in_word = false;
  for (const char c : arguments) {
    if (quote == ' ' && c == ' ') {
      in_word = false;
      continue;
    }
    if (!in_word) {
      words.emplace_back();
      in_word = true;
    }
    if (c == quote) {
      quote = ' ';
    } else if (quote == ' ' && (c == '\'' || c == '"')) {
      quote = c;
    } else {
      words.back() += c;
    }
  }
  return words;
}

/// Runs the program with these words in `folder`, within this process.
inline Outcome kelpie(const std::filesystem::path& folder, const std::vector<std::string>& words) {
  const std::filesystem::path here = std::filesystem::current_path();
  std::filesystem::current_path(folder);
  const cli::TextStream out;
  const cli::TextStream err;
  const int code = cli::program(words, {.out = out.file(), .err = err.file()});
  std::filesystem::current_path(here);
  return {code, out.text(), err.text()};
}

/// The same with the words of `arguments`.
inline Outcome kelpie(const std::filesystem::path& folder, const std::string& arguments) {
  return kelpie(folder, words_of(arguments));
}

/// Runs the built program in a process of its own, without a terminal.
inline Outcome kelpie_process(const std::filesystem::path& folder, const std::string& arguments) {
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

/// Commands in a folder of their own; the names of files are relative to the folder.
class CommandTest : public ::testing::Test {
 protected:
  Outcome run(const std::string& arguments) const { return kelpie(folder_.path(), arguments); }

  /// A command with `--out refused` has to be refused, and to write nothing.
  void expect_nothing_written(const std::string& command, const std::string& message) const {
    expect_refused(run(command + " --out refused"), message);
    EXPECT_FALSE(exists("refused")) << command;
  }

  /// A little log in log.csv, and in the folder out what `kelpie learn` with few samples makes of
  /// the log: learned once for all tests of the process.
  void learn_little_log(std::size_t rows = 2400) const {
    static std::map<std::size_t, std::map<std::string, std::string>> learned;
    write("log.csv", little_log(rows));
    std::map<std::string, std::string>& files = learned[rows];
    if (files.empty()) {
      succeeded(run("learn log.csv --out out" + kFewSamples));
      for (const auto& file : std::filesystem::directory_iterator(folder_ / "out")) {
        files[file.path().filename()] = content_of(file.path());
      }
    }
    std::filesystem::create_directory(folder_ / "out");
    for (const auto& [name, text] : files) {
      write("out/" + name, text);
    }
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

}  // namespace kelpie::testing
