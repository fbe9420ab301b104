// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sqlite3.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "bag/bags.hpp"
#include "support.hpp"

namespace kelpie::testing {

inline constexpr std::size_t kPage = 4096;

/// An interior page of an SQLite table, of 500 cells that name the same page, counted from 1.
inline std::string page_of_one_child(std::uint32_t child) {
  constexpr std::size_t kCells = 500;
  std::string page(kPage, '\0');
  const auto put = [&page](std::size_t at, std::size_t bytes, std::size_t value) {
    for (; bytes > 0; --bytes, value /= 256) {
      page[at + bytes - 1] = static_cast<char>(value % 256);
    }
  };
  constexpr std::size_t kCell = 5;
  put(0, 1, 5);  // interior
  put(3, 2, kCells);
  put(5, 2, kPage - kCells * kCell);
  put(8, 4, child);
  for (std::size_t cell = 1; cell <= kCells; ++cell) {
    put(10 + 2 * cell, 2, kPage - cell * kCell);
    put(kPage - cell * kCell, 4, child);
    page[kPage - cell * kCell + 4] = 1;
  }
  return page;
}

/// A recording of 40 kB whose table with this root page (3: messages, 4: definitions) has five
/// levels of pages of one child: 500^6 rows. Returns the bytes.
inline std::size_t write_endless_db3(const std::filesystem::path& file, std::size_t root) {
  std::filesystem::remove(file);
  write_db3(file, small_topics(), small_messages(2));
  sqlite3* raw = nullptr;
  sqlite3_open(file.c_str(), &raw);
  sqlite3_exec(raw,
               "CREATE TABLE message_definitions(topic_type, encoding, "
               "encoded_message_definition); INSERT INTO message_definitions VALUES(1, 2, 3)",
               nullptr, nullptr, nullptr);
  sqlite3_close(raw);
  std::string bytes = read_text(file);
  EXPECT_EQ(bytes.size(), 4 * kPage);
  bytes += bytes.substr((root - 1) * kPage, kPage);
  for (std::uint32_t level = 5; level < 10; ++level) {
    bytes += page_of_one_child(level);
  }
  bytes.replace((root - 1) * kPage, kPage, page_of_one_child(10));
  bytes[31] = 10;  // pages
  write_text(file, bytes);
  return bytes.size();
}

}  // namespace kelpie::testing
