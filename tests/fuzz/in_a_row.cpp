// SPDX-License-Identifier: Apache-2.0
// The program kelpie for scripts/mutate.py: without words, many commands in one process, because a
// start with sanitizers takes ten times as long as a small file. Each line of the standard input is
// a command, its words apart by tabs; the first word names the file of the command's errors, whose
// last line is the exit code.

#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "cli/program.hpp"

int main(int argc, char** argv) {
  if (argc > 1) {
    return kelpie::cli::program({argv + 1, argv + argc}, {});
  }
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream stream(line);
    std::string errors;
    std::getline(stream, errors, '\t');
    std::vector<std::string> words;
    for (std::string word; std::getline(stream, word, '\t');) {
      words.push_back(word);
    }
    if (std::freopen(errors.c_str(), "w", stderr) == nullptr) {
      return 3;
    }
    const int code = kelpie::cli::program(words, {});
    std::fprintf(stderr, "\n%d", code);
    std::fflush(stderr);
  }
  return 0;
}
