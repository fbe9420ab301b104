// SPDX-License-Identifier: Apache-2.0
#include "cli/run_program.hpp"

#include <exception>
#include <string>

#include "cli/output.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::cli {
namespace {

constexpr int kFailed = 1;
constexpr int kBadInput = 2;

// The parser takes -1 for the largest number there is.
void refuse_negative_counts(CLI::App& app) {
  const CLI::Validator not_negative(
      [](const std::string& text) {
        return text.starts_with('-') ? text + " has to be a whole number, 0 or more" : "";
      },
      "");
  for (CLI::Option* const option : app.get_options()) {
    if (option->get_type_name().starts_with("UINT")) {
      option->check(not_negative);
    }
  }
  for (CLI::App* const command : app.get_subcommands({})) {
    refuse_negative_counts(*command);
  }
}

// What was said before an error appears before it.
int failed(int code, const std::exception& error) {
  static_cast<void>(std::fflush(stdout));  // it fails already
  warn("kelpie: {}\n", error.what());
  return code;
}

}  // namespace

int run_program(CLI::App& app, int argc, char** argv) {
  try {
    refuse_negative_counts(app);
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      if (app.exit(error) != 0) {
        return kBadInput;
      }
    }
    finish_output();
    return 0;
  } catch (const InputError& error) {
    return failed(kBadInput, error);
  } catch (const std::exception& error) {
    return failed(kFailed, error);
  }
}

}  // namespace kelpie::cli
