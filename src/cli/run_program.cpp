// SPDX-License-Identifier: Apache-2.0
#include "cli/run_program.hpp"

#include <fmt/core.h>

#include <exception>

#include "kelpie/core/error.hpp"

namespace kelpie::cli {
namespace {

constexpr int kFailed = 1;
constexpr int kBadInput = 2;

}  // namespace

int run_program(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadInput;
  } catch (const InputError& error) {
    fmt::print(stderr, "kelpie: {}\n", error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    fmt::print(stderr, "kelpie: {}\n", error.what());
    return kFailed;
  }
}

}  // namespace kelpie::cli
