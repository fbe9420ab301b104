// SPDX-License-Identifier: Apache-2.0
// The table of docs/howto/logs.md: what kelpie takes of the logs at hand without an option. A row
// that differs is printed as it should be.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "log/read_log.hpp"
#include "support.hpp"

namespace kelpie::log_table_test {
namespace {

std::string row_of(const std::string& name, const std::string& path) {
  const auto row = [&](const std::string& inputs, const std::string& targets,
                       const std::string& rate) {
    return fmt::format("| `{}` | {} | {} | {} |", name, inputs, targets, rate);
  };
  try {
    const log::Dataset data = log::read_log({.path = path}, {}, {}).dataset();
    return row(join_text(data.input_names, " "), join_text(data.target_names, " "),
               fmt::format("{:.3g}", data.rate_hz));
  } catch (const InputError& error) {
    std::string asks;
    for (const std::string& open : log::draft_of(log::LogSource{.path = path}).open) {
      asks += (asks.empty() ? "" : "; ") + open.substr(0, open.find_first_of(":;"));
    }
    return row("asks: " + (asks.empty() ? error.place().field : asks), "", "");
  }
}

TEST(LogTable, OfTheDocsIsWhatIsTaken) {
  std::ifstream page(KELPIE_SOURCE_DIR "/docs/howto/logs.md");
  std::size_t rows = 0;
  bool is_table = false;
  for (std::string line; std::getline(page, line);) {
    is_table = line.starts_with("## ") ? line == "## Logs at hand" : is_table;
    if (!is_table || !line.starts_with("| `")) {
      continue;
    }
    ++rows;
    const std::string name = line.substr(3, line.find('`', 3) - 3);
    if (const auto file = testing::data_file(name); !file.empty()) {
      EXPECT_EQ(line, row_of(name, file.string()));
    }
  }
  EXPECT_GT(rows, 30U);
}

}  // namespace
}  // namespace kelpie::log_table_test
