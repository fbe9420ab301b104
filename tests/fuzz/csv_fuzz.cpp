// SPDX-License-Identifier: Apache-2.0
// libFuzzer's target for CSV files, packed ones as well: whatever the bytes, reading them and
// taking their columns ends in a dataset or an InputError. CONTRIBUTING.md has the command.

#include <cstddef>
#include <cstdint>
#include <string>

#include "kelpie/core/error.hpp"
#include "log/dataset.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const kelpie::log::Table table = kelpie::log::parse_csv(std::string(data, data + size), "fuzz");
    kelpie::log::csv_text(table);
    kelpie::log::make_dataset(table, kelpie::log::guess_roles(table, {}));
  } catch (const kelpie::InputError&) {  // the only exception that is due
    return 0;
  }
  return 0;
}
