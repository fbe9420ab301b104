// SPDX-License-Identifier: Apache-2.0
// libFuzzer's target for what the arrays of a .mat file become: whatever the names and sizes,
// topics with rows. CONTRIBUTING.md has the command.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bag/mat_topics.hpp"

namespace {

// Arrays of names and sizes as the bytes say, three of them each.
void group(std::span<const std::uint8_t> bytes) {
  std::vector<kelpie::bag::MatArray> arrays;
  for (; bytes.size() >= 3; bytes = bytes.subspan(3)) {
    const std::string name = (bytes[0] & 1U) != 0 ? "t" : "u" + std::to_string(bytes[0] % 8);
    kelpie::bag::MatArray& array = arrays.emplace_back();
    array.path = ((bytes[0] & 2U) != 0 ? "log." : "") + name;
    array.rows = bytes[1] % 8 + 1U;
    array.columns = bytes[2] % 8 + 1U;
    for (std::size_t k = 0; k < array.rows * array.columns; ++k) {
      array.values.push_back(static_cast<double>(k) * bytes[2] * 1e17);
    }
  }
  for (const kelpie::bag::MatTopic& topic : kelpie::bag::mat_topics(arrays, {})) {
    for (const kelpie::bag::MatTopic::Column& column : topic.columns) {
      for (std::size_t row = 0; row < topic.times_ns.size(); ++row) {
        column.value(row, column.width() - 1);
      }
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  group(std::span(data, size).first(std::min<std::size_t>(size, 60)));
  return 0;
}
