// SPDX-License-Identifier: Apache-2.0
#include "cli/program.hpp"

// NOLINTNEXTLINE(bugprone-exception-escape): options throw only where two have one name
int main(int argc, char** argv) {
  return kelpie::cli::program({argv + 1, argv + argc}, {});
}
